# SPDX-License-Identifier: MIT
# rtrays_quick_host_code()
#
# Of the calling folder and those below: -O1 in release builds, with the precompiled header made at -O1 (GCC's brings its own
# level). For host code that builds scenes, programs and launches; what is hot runs on the device, whose driver compiles it.
macro(rtrays_quick_host_code)
    string(REPLACE -O3 -O1 CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
    set(RTRAYS_PRECOMPILED rtrays_base)
endmacro()

# rtrays_hot_host_code(FILE...)
#
# Files of such a folder that trace rays themselves: -O3 again.
function(rtrays_hot_host_code)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON)
endfunction()
