// SPDX-License-Identifier: MIT
// Main program of all tests. It extends gtest_main with a testing::TempDir() for this process
// alone, because ctest runs many processes at once.
#include <gtest/gtest.h>
#include <stdlib.h>

#include "renderer/testing/float_traps.h"
#include "renderer/testing/temporary_folder.h"

int main(int argc, char **argv) {
    testing::InitGoogleTest(&argc, argv);
    const rtrays::TemporaryFolder folder;
    setenv("TEST_TMPDIR", folder.path().c_str(), 1);
#ifdef RTRAYS_TRAPS
    rtrays::test::trap_invalid();
#endif
    return RUN_ALL_TESTS();
}
