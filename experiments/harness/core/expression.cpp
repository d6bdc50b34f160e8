// SPDX-License-Identifier: MIT
#include "experiments/harness/core/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"

namespace rtrays {

namespace {

constexpr int deepest = 64;  ///< maximum nesting of parentheses and signs

struct Function {
    const char *name;
    size_t arguments;
    double (*value)(double, double);
};

const std::array<Function, 16> functions = {{
    {"sqrt", 1, [](double x, double) { return std::sqrt(x); }},
    {"exp", 1, [](double x, double) { return std::exp(x); }},
    {"log", 1, [](double x, double) { return std::log(x); }},
    {"expm1", 1, [](double x, double) { return std::expm1(x); }},
    {"log1p", 1, [](double x, double) { return std::log1p(x); }},
    {"sin", 1, [](double x, double) { return std::sin(x); }},
    {"cos", 1, [](double x, double) { return std::cos(x); }},
    {"tan", 1, [](double x, double) { return std::tan(x); }},
    {"asin", 1, [](double x, double) { return std::asin(x); }},
    {"acos", 1, [](double x, double) { return std::acos(x); }},
    {"atan", 1, [](double x, double) { return std::atan(x); }},
    {"abs", 1, [](double x, double) { return std::abs(x); }},
    {"float", 1, [](double x, double) { return static_cast<double>(static_cast<float>(x)); }},
    {"min", 2, [](double x, double y) { return std::min(x, y); }},
    {"max", 2, [](double x, double y) { return std::max(x, y); }},
    {"atan2", 2, [](double y, double x) { return std::atan2(y, x); }},
}};

/// Recursive descent parser with one function per level of precedence.
class Parser {
  public:
    Parser(const std::string &text, const Names &names) : text_(text), names_(names) {}

    double whole() {
        const double value = sum();
        if (peek() != '\0') {
            fail("expected an operator");
        }
        return value;
    }

  private:
    double sum() {
        double value = product();
        for (;;) {
            if (accept('+')) {
                value += product();
            } else if (accept('-')) {
                value -= product();
            } else {
                return value;
            }
        }
    }

    double product() {
        double value = signed_power();
        for (;;) {
            if (accept('*')) {
                value *= signed_power();
            } else if (accept('/')) {
                value /= signed_power();
            } else {
                return value;
            }
        }
    }

    double signed_power() {
        if (++depth_ > deepest) {
            fail("nested too deeply");
        }
        double value = 0;
        if (accept('-')) {
            value = -signed_power();
        } else {
            value = atom();
            value = accept('^') ? std::pow(value, signed_power()) : value;
        }
        --depth_;
        return value;
    }

    double atom() {
        if (accept('(')) {
            const double value = sum();
            require(')');
            return value;
        }
        if (std::isalpha(static_cast<unsigned char>(peek())) != 0) {
            return name();
        }
        double value = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc()) {
            fail("expected a number, a name or a parenthesis");
        }
        at_ = static_cast<size_t>(end - text_.data());
        return value;
    }

    double name() {
        const size_t begin = at_;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
            ++at_;
        }
        const std::string word = text_.substr(begin, at_ - begin);
        if (accept('(')) {
            const auto *function = std::find_if(functions.begin(), functions.end(),
                                                [&](const Function &f) { return word == f.name; });
            if (function == functions.end()) {
                fail(fmt::format("unknown function '{}'", word));
            }
            std::array<double, 2> arguments{};
            for (size_t i = 0; i < function->arguments; ++i) {
                if (i > 0) {
                    require(',');
                }
                arguments[i] = sum();
            }
            require(')');
            return function->value(arguments[0], arguments[1]);
        }
        return word == "pi" ? pi : names_(word);
    }

    char peek() {
        while (at_ < text_.size() && text_[at_] == ' ') {
            ++at_;
        }
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool accept(char wanted) {
        const bool is = peek() == wanted;
        at_ += is ? 1 : 0;
        return is;
    }
    void require(char wanted) {
        if (!accept(wanted)) {
            fail(fmt::format("expected '{}'", wanted));
        }
    }
    [[noreturn]] void fail(const std::string &what) const {
        throw input_error(fmt::format("formula '{}': {} at character {}", text_, what, at_ + 1));
    }

    const std::string &text_;
    const Names &names_;
    size_t at_ = 0;
    int depth_ = 0;
};

}  // namespace

double evaluate(const std::string &formula, const Names &names) {
    return Parser(formula, names).whole();
}

}  // namespace rtrays
