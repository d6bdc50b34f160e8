// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace rtrays {

using Json = nlohmann::json;

/// Deeper documents are refused, so that recursive readers cannot exhaust the stack.
constexpr size_t max_json_depth = 256;

/// Strict JSON: syntax errors, duplicate keys, numbers beyond double and nesting beyond
/// `max_json_depth` throw `Error` (bad input) as `SOURCE:LINE: PATH: what is wrong`.
Json parse_json(const std::string &text, const std::string &source_name);

/// `parse_json` of a file.
Json load_json(const std::filesystem::path &path);

/// `SOURCE:LINE: POINTER` (or `SOURCE: POINTER` when `text` is empty or has no such value): the
/// head of a message about the value at `pointer` (RFC 6901) of the document `text`.
std::string json_location(const std::string &source_name, const std::string &text,
                          const std::string &pointer);

/// Checks `document` against a JSON Schema (draft 7). On failure throws `Error` (bad input) naming
/// the source, the path of the offending value, what is wrong with it and, for an unknown key or
/// enum value, the alternatives. Given the `text` that `document` was parsed from, the line is
/// named too.
void validate_json(const Json &document, const std::string &schema_text,
                   const std::string &source_name, const std::string &text = {});

}  // namespace rtrays
