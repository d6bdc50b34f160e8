// SPDX-License-Identifier: MIT
// Tables of named values, which print and parse values without a second list of their names.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rtrays {

/// A value and its name in settings, reports and files.
template <typename T>
struct Named {
    T value;
    const char *name;
};

/// Returns the name of a value. The table must have a row for it.
template <typename T, size_t n>
constexpr const char *name_in(const Named<T> (&table)[n], const T &value) {
    size_t row = 0;
    while (table[row].value != value) {
        ++row;
    }
    return table[row].name;
}

/// Returns the value that has a name, or nothing if no row of the table has that name.
template <typename T, size_t n>
constexpr std::optional<T> find_named(const Named<T> (&table)[n], std::string_view name) {
    for (const Named<T> &row : table) {
        if (row.name == name) {
            return row.value;
        }
    }
    return std::nullopt;
}

}  // namespace rtrays
