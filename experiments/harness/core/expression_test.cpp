// SPDX-License-Identifier: MIT
// Tests of formulas: precedence, functions and errors.
#include "experiments/harness/core/expression.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/base/error.h"

namespace rtrays {
namespace {

double value_of(const std::string &formula) {
    return evaluate(formula, [](const std::string &name) {
        if (name != "x") {
            throw input_error(fmt::format("'{}' is not defined", name));
        }
        return 3.0;
    });
}

TEST(Expression, HasTheUsualPrecedence) {
    EXPECT_EQ(value_of("1 + 2 * x"), 7);
    EXPECT_EQ(value_of("(1 + 2) * x - 8 / 4 / 2"), 8);
    EXPECT_EQ(value_of("-x ^ 2"), -9);
    EXPECT_EQ(value_of("2 ^ -1"), 0.5);
    EXPECT_EQ(value_of("2 ^ x ^ 2"), 512);
    EXPECT_EQ(value_of("1e-6 * 1.5E+6"), 1.5);
}

TEST(Expression, KnowsItsFunctions) {
    EXPECT_DOUBLE_EQ(value_of("sqrt(x) * sin(pi / 6) + max(min(1, x), -2)"),
                     std::sqrt(3.0) / 2 + 1);
    EXPECT_DOUBLE_EQ(value_of("expm1(1e-20) / log1p(1e-20)"), 1);
    EXPECT_DOUBLE_EQ(value_of("atan2(1, -1)"), std::atan2(1.0, -1.0));
    EXPECT_EQ(value_of("float(0.1)"), static_cast<double>(0.1f));
    EXPECT_NE(value_of("float(0.1)"), 0.1);
}

TEST(Expression, SaysWhatIsWrongWithAFormula) {
    for (const std::string formula : {"", "1 +", "(1", "1 2", "sqrt 2", "sqrt()", "max(1)",
                                      "cbrt(8)", "y", "1 / z + x", "2 ** 3"}) {
        EXPECT_THROW(value_of(formula), Error) << formula;
    }
    EXPECT_THROW(value_of(std::string(100000, '(') + "1"), Error);
    EXPECT_THROW(value_of(std::string(100000, '-') + "1"), Error);
}

}  // namespace
}  // namespace rtrays
