# goshawk_no_middleware_test.cmake accepts a core, and refuses it as soon as one include is wrong.
# cmake -DWORK=FOLDER -P no_middleware_test_notices.cmake
cmake_minimum_required(VERSION 3.25)

# Checks a core `x` with `line` in `file`. @return what the check printed, or "accepted"
function(verdict_of file line result)
  file(REMOVE_RECURSE ${WORK})
  file(WRITE ${WORK}/include/goshawk/x/x.hpp "#include <vector>\n#include \"goshawk/core/result.hpp\"\n")
  file(WRITE ${WORK}/src/x.cpp "#include \"goshawk/x/x.hpp\"\n#include \"part.hpp\"\n")
  file(WRITE ${WORK}/src/part.hpp "#include \"goshawk/x/x.hpp\"\n#include <octomap/OcTree.h>\n")
  file(APPEND ${WORK}/${file} "${line}\n")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -DNAME=x -DFOLDER=${WORK} -DSOURCES=src/x.cpp "-DALLOWED=goshawk_core;goshawk_plant"
            -P ${CMAKE_CURRENT_LIST_DIR}/../cmake/goshawk_no_middleware_test.cmake
    RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(status EQUAL 0)
    set(said accepted)
  endif()
  string(REGEX REPLACE "[ \n]+" " " said "${said}")  # CMake breaks long lines
  set(${result} "${said}" PARENT_SCOPE)
endfunction()

function(expect file line expected)
  verdict_of(${file} "${line}" said)
  if(NOT said MATCHES "${expected}")
    message(FATAL_ERROR "${file} with ${line}: expected \"${expected}\", got: ${said}")
  endif()
endfunction()

set(public include/goshawk/x/x.hpp)
set(source src/x.cpp)
set(private src/part.hpp)
foreach(file ${public} ${source} ${private})
  expect(${file} "#include \"goshawk/core/polytope.hpp\"" "accepted")
  expect(${file} "#include \"goshawk/plant/plant_model.hpp\"" "accepted")
  expect(${file} "// goshawk_msgs are for components" "accepted")
  foreach(header <fastdds/dds/topic/Topic.hpp> <fastrtps/types/TypesBase.h> <fastcdr/Cdr.h>
      <dds/dds.h> "\"goshawk_msgs.h\"" "\"nav_msgs.h\"" "\"goshawk_msgsPubSubTypes.h\""
      "\"goshawk/runtime/node.hpp\"" "\"goshawk/stage/intake.hpp\"" "\"goshawk/conversions/plan.hpp\"")
    expect(${file} "#include ${header}" "includes middleware")
  endforeach()
  expect(${file} "#  include \"goshawk/runtime/node.hpp\"" "includes middleware")
  expect(${file} "#include \"goshawk/tracker/tracker.hpp\"" "includes another stage")
endforeach()
