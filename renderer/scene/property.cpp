// SPDX-License-Identifier: MIT
#include "renderer/scene/property.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/json.h"

namespace rtrays {

namespace {

/// Appends all numbers of nested arrays; clears `only_numbers` if there is any other value.
void flatten(const Json &value, std::vector<double> &numbers, bool &only_numbers) {
    if (value.is_array()) {
        for (const Json &item : value) {
            flatten(item, numbers, only_numbers);
        }
    } else if (value.is_number()) {
        numbers.push_back(value.get<double>());
    } else {
        only_numbers = false;
    }
}

/// Returns exactly `count` numbers, with or without brackets, or an empty vector for any other
/// text.
std::vector<double> parse_numbers(const std::string &text, size_t count) {
    std::vector<double> numbers;
    bool only_numbers = true;
    try {
        flatten(parse_json("[" + text + "]", "value"), numbers, only_numbers);
    } catch (const Error &) {
        only_numbers = false;
    }
    return only_numbers && numbers.size() == count ? numbers : std::vector<double>{};
}

struct ToText {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    /// Values that are floats have the digits of a float: 0.6 instead of 0.6000000238418579.
    std::string operator()(double value) const {
        const auto single = static_cast<float>(value);
        return static_cast<double>(single) == value ? fmt::format("{}", single)
                                                    : fmt::format("{}", value);
    }
    template <int size>
    std::string operator()(const Eigen::Matrix<double, size, 1> &v) const {
        std::string text;
        for (int i = 0; i < size; ++i) {
            text += (i > 0 ? ", " : "") + (*this)(v[i]);
        }
        return "[" + text + "]";
    }
    std::string operator()(const Eigen::Matrix4d &m) const {
        std::vector<std::string> rows;
        for (int i = 0; i < 4; ++i) {
            rows.push_back((*this)(Eigen::Vector4d(m.row(i))));
        }
        return fmt::format("[{}]", fmt::join(rows, ", "));
    }
    std::string operator()(const std::string &value) const { return value; }
};

/// Replaces the visited alternative by the value of the text. Returns false if the text has another
/// type.
struct FromText {
    const std::string &text;

    bool operator()(bool &value) const {
        value = text == "true";
        return value || text == "false";
    }
    bool operator()(double &value) const {
        const std::vector<double> numbers = parse_numbers(text, 1);
        value = numbers.empty() ? value : numbers[0];
        return !numbers.empty();
    }
    template <int size>
    bool operator()(Eigen::Matrix<double, size, 1> &value) const {
        std::vector<double> numbers = parse_numbers(text, size);
        if (size <= 3 && numbers.empty()) {
            const std::vector<double> all = parse_numbers(text, 1);
            numbers.assign(size * all.size(), all.empty() ? 0 : all[0]);
        }
        if (!numbers.empty()) {
            value = Eigen::Map<const Eigen::Matrix<double, size, 1>>(numbers.data());
        }
        return !numbers.empty();
    }
    bool operator()(Eigen::Matrix4d &value) const {
        const std::vector<double> numbers = parse_numbers(text, 16);
        if (!numbers.empty()) {
            value = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
        }
        return !numbers.empty();
    }
    bool operator()(std::string &value) const {
        value = text;
        return true;
    }
};

}  // namespace

std::string property_text(const PropertyValue &value) {
    return std::visit(ToText{}, value);
}

const char *property_type(const PropertyValue &value) {
    constexpr const char *names[] = {"boolean",      "number",     "two numbers", "three numbers",
                                     "four numbers", "4x4 matrix", "text"};
    static_assert(std::size(names) == std::variant_size_v<PropertyValue>);
    return names[value.index()];
}

std::string Property::type() const {
    if (!choices.empty()) {
        return fmt::format("one of: {}", fmt::join(choices, ", "));
    }
    return property_type(get());
}

std::string Property::text() const {
    return property_text(get());
}

void Property::set_text(const std::string &text) const {
    if (!set) {
        throw input_error("the property is read-only");
    }
    PropertyValue value = get();
    const bool is_choice =
        choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end();
    if (!is_choice || !std::visit(FromText{text}, value)) {
        throw input_error(fmt::format("'{}' is not {}{}", text,
                                      choices.empty() ? "a value of type " : "", type()));
    }
    set(value);
}

}  // namespace rtrays
