# SPDX-License-Identifier: MIT
# Optimisation of host code in release builds. Most host code builds scenes, programs and launches: -O1 compiles faster,
# and the hot code runs on the device, whose driver compiles it. A target with RTRAYS_TRACES_RAYS on gets -O3.
target_compile_options(rtrays_options INTERFACE
    $<$<CONFIG:Release>:$<IF:$<BOOL:$<TARGET_PROPERTY:RTRAYS_TRACES_RAYS>>,-O3,-O1>>)

# rtrays_hot_host_code(FILE...): -O3 for single files that trace rays. They cannot use the target's precompiled header,
# which has its own level.
function(rtrays_hot_host_code)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON)
endfunction()
