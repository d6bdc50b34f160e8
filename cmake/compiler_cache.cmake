# SPDX-License-Identifier: MIT
# Objects are taken from ccache where it is installed, also by other clones of the repository (in its default folder,
# at most 5 GB). Results do not depend on it: its key covers the compiler, the options and the preprocessed text.
# Precompiled headers need -fpch-preprocess and the sloppiness that ccache's manual names for them.
find_program(RTRAYS_CCACHE ccache)
mark_as_advanced(RTRAYS_CCACHE)
if(RTRAYS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${RTRAYS_CCACHE})
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
endif()
