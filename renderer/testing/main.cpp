// SPDX-License-Identifier: MIT
// Main program of all tests. It extends gtest_main with a testing::TempDir() for this process
// alone, because ctest runs many processes at once.
#include <gtest/gtest.h>
#include <stdlib.h>

#include "renderer/testing/float_traps.h"
#include "renderer/testing/temporary_folder.h"

#ifdef __SANITIZE_ADDRESS__
/// Options of the address sanitizer. Its leak check guesses where a library opened by dlopen, such
/// as the image module, has its thread-local memory, and may read at a wrong address.
extern "C" const char *__asan_default_options() {
    return "intercept_tls_get_addr=0";
}
#endif

int main(int argc, char **argv) {
    testing::InitGoogleTest(&argc, argv);
    const rtrays::TemporaryFolder folder;
    setenv("TEST_TMPDIR", folder.path().c_str(), 1);
#ifdef RTRAYS_TRAPS
    rtrays::test::trap_invalid();
#endif
    return RUN_ALL_TESTS();
}
