#!/bin/sh
# A compiler launcher that compiles and links with clang++ instead: libFuzzer is clang's.
shift
exec clang++ "$@"
