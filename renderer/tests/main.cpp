// SPDX-License-Identifier: MIT
// The main program of all tests: as gtest_main, with a testing::TempDir() of this process alone,
// for ctest runs many at once.
#include <gtest/gtest.h>
#include <stdlib.h>

#include "renderer/tests/float_traps.h"
#include "renderer/tests/temporary_folder.h"

int main(int argc, char **argv) {
    testing::InitGoogleTest(&argc, argv);
    const rtrays::TemporaryFolder folder;
    setenv("TEST_TMPDIR", folder.path().c_str(), 1);
#ifdef RTRAYS_TRAPS
    rtrays::test::trap_invalid();
#endif
    return RUN_ALL_TESTS();
}
