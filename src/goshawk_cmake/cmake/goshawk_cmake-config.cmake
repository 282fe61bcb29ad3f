# What all Goshawk packages share: language, warnings, sanitizers, targets, tests, install and export.
#
#   goshawk_project_setup()                          once, after project()
#   goshawk_core_library(NAME SOURCES LINK ...)      the middleware-free library of a package
#   goshawk_component(NAME CLASS SOURCES LINK ...)   a component, loadable by goshawk_container
#   goshawk_executable(NAME SOURCES LINK ...)        a program, installed to bin/
#   goshawk_test(NAME SOURCES LINK ...)              a GoogleTest program, one file of results each
#   goshawk_fuzz(NAME RUNS SOURCES LINK CORPUS)     a libFuzzer program and a short run of it
#   goshawk_benchmark(NAME SOURCES LINK ...)         a Google Benchmark program, built with the tests
#   goshawk_package_install(DEPENDENCIES ...)        last: headers, config/, targets, CMake package

set(GOSHAWK_CMAKE_DIR "${CMAKE_CURRENT_LIST_DIR}")

macro(goshawk_project_setup)
  set(CMAKE_CXX_STANDARD 20)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
  endif()
  # -O2: within a few per cent of -O3 here, and a third less to compile. No contraction: a run
  # replays bit for bit on machines with and without fused multiply-add. NDEBUG stays unset in
  # our own code, so that asserts are a part of what is tested and flown.
  set(CMAKE_CXX_FLAGS_RELEASE "-O2")
  add_compile_options(-ffp-contract=off)
  # A component that misses a symbol fails here, not when a user loads it.
  add_link_options(-Wl,--no-undefined)
  option(GOSHAWK_WERROR "Warnings are errors" ON)
  option(GOSHAWK_NATIVE "Compile for this machine's processor only" OFF)
  set(GOSHAWK_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")
  if(GOSHAWK_NATIVE)
    add_compile_options(-march=native)
  endif()
  if(GOSHAWK_SANITIZE)
    add_compile_options(-fsanitize=${GOSHAWK_SANITIZE} -fno-omit-frame-pointer -g)
    add_link_options(-fsanitize=${GOSHAWK_SANITIZE})
  endif()
  # Several sources of a target in one compilation: what they include costs more than what they say.
  # OFF while one file is edited again and again.
  option(GOSHAWK_UNITY "Compile sources in batches" ON)
  set(CMAKE_UNITY_BUILD ${GOSHAWK_UNITY})
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)
  find_program(GOSHAWK_CCACHE ccache)
  if(GOSHAWK_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${GOSHAWK_CCACHE})
    set(CMAKE_C_COMPILER_LAUNCHER ${GOSHAWK_CCACHE})
  endif()
  # Installed programs and libraries find each other without a sourced setup file.
  set(CMAKE_INSTALL_LIBDIR lib)
  set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/../lib")
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
  set(GOSHAWK_TARGETS "")
  include(CTest)
endmacro()

# No -Wmaybe-uninitialized: g++ 12 sees it in every std::variant that is moved. No
# -Wsubobject-linkage: in a batch, what a source keeps to itself looks like a header's.
function(_goshawk_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    -Woverloaded-virtual -Wno-maybe-uninitialized -Wno-subobject-linkage
    $<$<BOOL:${GOSHAWK_WERROR}>:-Werror>)
endfunction()


# goshawk_core_library(NAME path_search SOURCES ... LINK ... PRIVATE_LINK ... ALSO goshawk_x)
# makes libgoshawk_NAME.so, target goshawk_NAME::core after install. ALSO names further Goshawk
# libraries that it may use beside goshawk_core; a test proves that it links and includes nothing
# else of ours, and no middleware.
function(goshawk_core_library)
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINK;PRIVATE_LINK;ALSO" ${ARGN})
  set(target goshawk_${arg_NAME})
  add_library(${target} SHARED ${arg_SOURCES})
  add_library(${target}::core ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME core)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${target} PUBLIC ${arg_LINK} PRIVATE ${arg_PRIVATE_LINK})
  _goshawk_warnings(${target})
  # A consumer may be compiled for another processor: inline functions stay on either side.
  set(exports ${GOSHAWK_CMAKE_DIR}/core_library.map)
  target_compile_options(${target} PRIVATE -fvisibility-inlines-hidden)
  target_link_options(${target} PRIVATE -Wl,--version-script=${exports})
  set_target_properties(${target} PROPERTIES LINK_DEPENDS ${exports})
  if(BUILD_TESTING)
    list(FILTER arg_SOURCES EXCLUDE REGEX "^[$/]")  # objects made elsewhere, generated files
    set(sources ${arg_SOURCES})
    add_test(NAME ${target}_has_no_middleware
      COMMAND ${CMAKE_COMMAND} -DLIBRARY=$<TARGET_FILE:${target}> -DNAME=${arg_NAME}
              -DFOLDER=${CMAKE_CURRENT_SOURCE_DIR} "-DSOURCES=${sources}"
              "-DALLOWED=goshawk_core;${arg_ALSO}"
              -P ${GOSHAWK_CMAKE_DIR}/goshawk_no_middleware_test.cmake)
  endif()
  set(GOSHAWK_TARGETS ${GOSHAWK_TARGETS} ${target} PARENT_SCOPE)
endfunction()

# goshawk_component(NAME path_search SOURCES ... LINK ...) makes libgoshawk_NAME_component.so,
# which goshawk_container loads by the name NAME.
function(goshawk_component)
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINK" ${ARGN})
  find_package(goshawk_stage REQUIRED)
  set(target goshawk_${arg_NAME}_component)
  add_library(${target} MODULE ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ${arg_LINK} goshawk_stage::stage)
  _goshawk_warnings(${target})
  install(TARGETS ${target} LIBRARY DESTINATION lib)
endfunction()

function(goshawk_executable)
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINK" ${ARGN})
  add_executable(${arg_NAME} ${arg_SOURCES})
  target_link_libraries(${arg_NAME} PRIVATE ${arg_LINK})
  _goshawk_warnings(${arg_NAME})
  install(TARGETS ${arg_NAME} RUNTIME DESTINATION bin)
endfunction()

# Results go where `colcon test-result` looks. DATA points at the shared maps of the workplace;
# tests that need them skip with a message where they are absent.
function(goshawk_test)
  cmake_parse_arguments(arg "" "NAME;TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  if(NOT BUILD_TESTING)
    return()
  endif()
  find_package(GTest REQUIRED)
  add_executable(${arg_NAME} ${arg_SOURCES})
  target_link_libraries(${arg_NAME} PRIVATE ${arg_LINK} GTest::gmock_main)
  _goshawk_warnings(${arg_NAME})
  # Tests spend their time in the libraries, which are optimised; compiling them is what costs.
  target_compile_options(${arg_NAME} PRIVATE -O1)
  set(results ${CMAKE_CURRENT_BINARY_DIR}/test_results/${PROJECT_NAME})
  add_test(NAME ${arg_NAME} COMMAND ${arg_NAME} --gtest_output=xml:${results}/${arg_NAME}.gtest.xml)
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  set_tests_properties(${arg_NAME} PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS "${arg_LABELS}")
endfunction()

# goshawk_fuzz(NAME query_fuzz RUNS 20000 SOURCES ... LINK ... CORPUS test/corpus): SOURCES are
# compiled by clang++ with libFuzzer and sanitizers; those of a library that are listed here take
# the place of the ones in LINK, so that the fuzzer sees their branches. Without clang++ the test is
# skipped, and says so.
function(goshawk_fuzz)
  cmake_parse_arguments(arg "" "NAME;RUNS;CORPUS" "SOURCES;LINK" ${ARGN})
  if(NOT BUILD_TESTING OR GOSHAWK_SANITIZE)
    return()
  endif()
  find_program(GOSHAWK_CLANGXX clang++)
  if(NOT GOSHAWK_CLANGXX)
    message(WARNING "clang++ is missing: ${arg_NAME} is not built and its test is skipped; run tools/setup")
    add_test(NAME ${arg_NAME} COMMAND ${CMAKE_COMMAND} -E echo "SKIPPED: no clang++")
    set_tests_properties(${arg_NAME} PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED")
    return()
  endif()
  set(fuzzing -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
  add_executable(${arg_NAME} ${arg_SOURCES})
  target_link_libraries(${arg_NAME} PRIVATE ${arg_LINK})
  target_compile_options(${arg_NAME} PRIVATE -O1 -g1 ${fuzzing})
  target_link_options(${arg_NAME} PRIVATE ${fuzzing})
  set_target_properties(${arg_NAME} PROPERTIES
    CXX_COMPILER_LAUNCHER ${GOSHAWK_CMAKE_DIR}/goshawk_clang.sh
    CXX_LINKER_LAUNCHER ${GOSHAWK_CMAKE_DIR}/goshawk_clang.sh)
  # What is new stays in the build folder; the corpus is read only.
  set(found ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}_corpus)
  file(MAKE_DIRECTORY ${found})
  add_test(NAME ${arg_NAME} COMMAND ${GOSHAWK_CMAKE_DIR}/goshawk_fuzz.sh $<TARGET_FILE:${arg_NAME}>
           ${arg_RUNS} ${found} ${CMAKE_CURRENT_SOURCE_DIR}/${arg_CORPUS})
  # The fuzzer itself ends what hangs; GOSHAWK_FUZZ_S may ask for half an hour.
  set_tests_properties(${arg_NAME} PROPERTIES TIMEOUT 7200 LABELS fuzz)
endfunction()

function(goshawk_benchmark)
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINK" ${ARGN})
  if(NOT BUILD_TESTING)
    return()
  endif()
  find_package(benchmark REQUIRED)
  add_executable(${arg_NAME} ${arg_SOURCES})
  target_link_libraries(${arg_NAME} PRIVATE ${arg_LINK} benchmark::benchmark)
  _goshawk_warnings(${arg_NAME})
  install(TARGETS ${arg_NAME} RUNTIME DESTINATION bin)
endfunction()

# goshawk_package_install(DEPENDENCIES goshawk_core Eigen3): headers, config/*.yaml and the targets.
function(goshawk_package_install)
  cmake_parse_arguments(arg "" "" "DEPENDENCIES" ${ARGN})
  set(here lib/cmake/${PROJECT_NAME})
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/include)
    install(DIRECTORY include/ DESTINATION include)
  endif()
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/config)
    install(DIRECTORY config/ DESTINATION share/goshawk/config)
  endif()
  install(FILES package.xml DESTINATION share/${PROJECT_NAME})
  if(GOSHAWK_TARGETS)
    install(TARGETS ${GOSHAWK_TARGETS} EXPORT ${PROJECT_NAME}-targets
      LIBRARY DESTINATION lib ARCHIVE DESTINATION lib RUNTIME DESTINATION bin)
    install(EXPORT ${PROJECT_NAME}-targets NAMESPACE ${PROJECT_NAME}:: DESTINATION ${here})
    set(GOSHAWK_DEPENDENCIES ${arg_DEPENDENCIES})
    configure_file(${GOSHAWK_CMAKE_DIR}/package-config.cmake.in
      ${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}-config.cmake @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}-config.cmake DESTINATION ${here})
  endif()
endfunction()
