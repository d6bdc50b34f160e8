// SPDX-License-Identifier: MIT
// Strict reading of JSON and validation against a schema, with messages that name the line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace rtrays {

using Json = nlohmann::json;

/// Deepest nesting of a document; deeper ones are rejected, so that recursive readers cannot
/// exhaust the stack.
constexpr size_t max_json_depth = 256;

/// Parses strict JSON. Syntax errors, duplicate keys, numbers beyond the range of double and
/// nesting beyond `max_json_depth` throw `Error` (bad input) as `SOURCE:LINE: PATH: what is wrong`.
Json parse_json(const std::string &text, const std::string &source_name);

/// Reads and parses a file by `parse_json`.
Json load_json(const std::filesystem::path &path);

/// Returns the head of a message about the value at `pointer` (RFC 6901) of the document `text`:
/// `SOURCE:LINE: POINTER`, or `SOURCE: POINTER` if `text` is empty or does not have the value.
std::string json_location(const std::string &source_name, const std::string &text,
                          const std::string &pointer);

/// Validates `document` against a JSON Schema (draft 7). If it fails, throws `Error` (bad input)
/// naming the source, the path of the value and what is wrong with it. For an unknown key or enum
/// value the message lists the alternatives. It also names the line if `text` is the text that
/// `document` was parsed from. Several errors are lines of one message, at most ten.
void validate_json(const Json &document, const std::string &schema_text,
                   const std::string &source_name, const std::string &text = {});

}  // namespace rtrays
