// SPDX-License-Identifier: MIT
// Precompiled header of the tests.
#pragma once

#include <gtest/gtest.h>

#include "renderer/base/precompiled.h"
