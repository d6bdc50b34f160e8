# SPDX-License-Identifier: MIT
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
    set(commit "unknown")
endif()
execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no -- renderer reference experiments scenes
                        cmake CMakeLists.txt
                OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(changes)
    set(dirty "true")
else()
    set(dirty "false")
endif()
set(content "#pragma once\n#define RTRAYS_COMMIT \"${commit}\"\n#define RTRAYS_DIRTY ${dirty}\n")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} previous)
endif()
if(NOT "${content}" STREQUAL "${previous}")
    file(WRITE ${OUTPUT} "${content}")
endif()
