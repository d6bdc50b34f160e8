// SPDX-License-Identifier: MIT
// As renderer/base/precompiled.h, for tests.
#pragma once

#include <gtest/gtest.h>

#include "renderer/base/precompiled.h"
