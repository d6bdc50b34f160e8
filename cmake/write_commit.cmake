# SPDX-License-Identifier: MIT
# Run by the target rtrays_commit: writes OUTPUT, a header with the commit of SOURCE and whether its sources have changed.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
    set(commit "unknown")
endif()
# Only the sources of the programs count; a new report or result does not make the build dirty.
execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no -- renderer reference experiments scenes
                        cmake CMakeLists.txt
                OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(changes)
    set(dirty "true")
else()
    set(dirty "false")
endif()
set(content "#pragma once
#define RTRAYS_VERSION \"${VERSION}\"
#define RTRAYS_COMMIT \"${commit}\"
#define RTRAYS_DIRTY ${dirty}
")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} previous)
endif()
if(NOT "${content}" STREQUAL "${previous}")
    file(WRITE ${OUTPUT} "${content}")
endif()
