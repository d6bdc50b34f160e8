# SPDX-License-Identifier: MIT
# Generates a header with the commit and the dirty flag. Every build checks it, and it is rewritten only when
# it changes.
add_custom_target(rtrays_commit
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
            -DOUTPUT=${PROJECT_BINARY_DIR}/generated/rtrays_commit.h
            -P ${PROJECT_SOURCE_DIR}/cmake/write_commit.cmake
    BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/rtrays_commit.h
    COMMENT "Recording the commit" VERBATIM)
