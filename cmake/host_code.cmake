# SPDX-License-Identifier: MIT
# Host code builds scenes, programs and launches: -O1 in release builds. What is hot runs on the device, whose driver compiles it.
string(REPLACE -O3 -O1 CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")

# rtrays_hot_host_code(FILE...)
#
# Files that trace rays themselves: -O3 again, and so without the precompiled header, which brings its own level.
function(rtrays_hot_host_code)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON)
endfunction()
