// SPDX-License-Identifier: MIT
#include "renderer/base/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {

namespace {

/// Position of the lexer. The library does not pass it to its SAX callbacks, so lines are counted
/// as characters are consumed.
struct Position {
    size_t line = 1;
    char last = 0;
};

/// Iterator over the text that keeps `Position` up to date.
class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char *;
    using reference = const char &;

    CountingIterator(const char *current, Position *position)
        : current_(current), position_(position) {}

    reference operator*() const { return *current_; }
    CountingIterator &operator++() {
        position_->last = *current_++;
        position_->line += position_->last == '\n' ? 1 : 0;
        return *this;
    }
    bool operator==(const CountingIterator &other) const { return current_ == other.current_; }
    bool operator!=(const CountingIterator &other) const { return current_ != other.current_; }

  private:
    const char *current_;
    Position *position_;
};

/// Escapes a token of a JSON pointer (RFC 6901).
std::string escaped(std::string token) {
    for (const auto &[from, to] : {std::pair{"~", "~0"}, std::pair{"/", "~1"}}) {
        for (size_t at = token.find(from); at != std::string::npos; at = token.find(from, at + 2)) {
            token.replace(at, 1, to);
        }
    }
    return token;
}

/// Returns the "name" of an object, or nullptr. Users recognise it better than a path.
const std::string *name_of(const Json &value) {
    const auto found = value.is_object() ? value.find("name") : value.end();
    return found != value.end() && found->is_string() ? found->get_ptr<const std::string *>()
                                                      : nullptr;
}

/// SAX handler that builds the document and knows the path and line of each value.
class StrictReader {
  public:
    StrictReader(const std::string &source_name, const Position &position)
        : source_name_(source_name), position_(position) {}

    /// Records the line of the value at this pointer, and accepts duplicate keys.
    void look_for(const std::string &pointer) { wanted_ = &pointer; }

    Json take() { return std::move(root_); }
    size_t found_line() const { return found_line_; }

    // Callbacks of the library; `true` means continue.
    bool null() { return add(nullptr, false); }
    bool boolean(bool value) { return add(value, false); }
    bool number_integer(Json::number_integer_t value) { return add(value, true); }
    bool number_unsigned(Json::number_unsigned_t value) { return add(value, true); }
    bool number_float(Json::number_float_t value, const std::string &) { return add(value, true); }
    bool string(std::string &value) { return add(std::move(value), false); }
    bool binary(Json::binary_t &) { return false; }
    bool start_object(size_t) { return open(Json::object()); }
    bool start_array(size_t) { return open(Json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string &name) {
        Level &level = levels_.back();
        level.key = name;
        if (level.value->contains(name) && wanted_ == nullptr) {
            fail(fmt::format("duplicate key '{}'", name));
        }
        return true;
    }

    bool parse_error(size_t, const std::string &, const Json::exception &error) {
        // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
        std::string what = error.what();
        for (const char *head : {"[json.exception.", "parse error"}) {
            const size_t end = what.find(*head == '[' ? "] " : ": ");
            if (what.rfind(head, 0) == 0 && end != std::string::npos) {
                what.erase(0, end + 2);
            }
        }
        fail(what);
    }

  private:
    struct Level {
        Json *value;
        std::string key;  ///< key of the member being read, if `value` is an object
    };

    /// Pointer of the value that is being read or comes next.
    std::string pointer() const {
        std::string path;
        for (const Level &level : levels_) {
            // All arrays but the innermost already hold the element that is being read.
            const size_t unfinished = &level != &levels_.back() ? 1 : 0;
            path += level.value->is_array() ? fmt::format("/{}", level.value->size() - unfinished)
                                            : "/" + escaped(level.key);
        }
        return path;
    }

    [[noreturn]] void fail(const std::string &what) const {
        std::string path = pointer();
        for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
            if (const std::string *name = name_of(*level->value)) {
                path += fmt::format(" (in '{}')", *name);
                break;
            }
        }
        path += path.empty() ? "" : ": ";
        throw input_error(fmt::format("{}:{}: {}{}", source_name_, position_.line, path, what));
    }

    Json *place(Json &&value, bool is_number) {
        if (wanted_ != nullptr && found_line_ == 0 && pointer() == *wanted_) {
            // A number ends at the character after it, which may begin the next line.
            found_line_ = position_.line - (is_number && position_.last == '\n' ? 1 : 0);
        }
        if (levels_.empty()) {
            root_ = std::move(value);
            return &root_;
        }
        Level &level = levels_.back();
        if (level.value->is_array()) {
            level.value->push_back(std::move(value));
            return &level.value->back();
        }
        return &((*level.value)[level.key] = std::move(value));
    }

    bool add(Json &&value, bool is_number) {
        place(std::move(value), is_number);
        return true;
    }

    bool open(Json &&value) {
        if (levels_.size() == max_json_depth) {
            fail(fmt::format("nested deeper than {} levels", max_json_depth));
        }
        Json *placed = place(std::move(value), false);
        levels_.push_back({placed, {}});
        return true;
    }

    bool close() {
        levels_.pop_back();
        return true;
    }

    const std::string &source_name_;
    const Position &position_;
    const std::string *wanted_ = nullptr;
    size_t found_line_ = 0;
    Json root_;
    std::vector<Level> levels_;
};

/// Returns the line (from 1) of the value at `pointer`, or 0 if the text does not have the value.
size_t line_of(const std::string &text, const std::string &pointer) {
    Position position;
    StrictReader reader(pointer, position);
    reader.look_for(pointer);
    try {
        Json::sax_parse(CountingIterator(text.data(), &position),
                        CountingIterator(text.data() + text.size(), &position), &reader);
    } catch (const Error &) {
        // The text is not that of the document; a line found before the error is still valid.
    }
    return reader.found_line();
}

/// Follows local references. Schemas are part of the program, so a dangling reference is a bug.
const Json &resolved(const Json &root, const Json &schema) {
    const Json *node = &schema;
    while (node->is_object() && node->contains("$ref")) {
        node = &root.at(Json::json_pointer(node->at("$ref").get<std::string>().substr(1)));
    }
    return *node;
}

/// Appends all schema nodes that apply to the value of `schema`, including those of combinators.
void collect(const Json &root, const Json &schema, std::vector<const Json *> &nodes) {
    const Json &node = resolved(root, schema);
    if (!node.is_object()) {
        return;
    }
    nodes.push_back(&node);
    for (const char *combinator : {"allOf", "anyOf", "oneOf"}) {
        if (node.contains(combinator)) {
            for (const Json &branch : node.at(combinator)) {
                collect(root, branch, nodes);
            }
        }
    }
    for (const char *branch : {"then", "else"}) {
        if (node.contains(branch)) {
            collect(root, node.at(branch), nodes);
        }
    }
}

/// Returns the schema nodes that apply to the value at `path`.
std::vector<const Json *> schema_nodes(const Json &root, const std::vector<std::string> &path) {
    std::vector<const Json *> nodes;
    collect(root, root, nodes);
    for (const std::string &token : path) {
        std::vector<const Json *> next;
        for (const Json *node : nodes) {
            if (node->contains("properties") && node->at("properties").contains(token)) {
                collect(root, node->at("properties").at(token), next);
            } else if (node->contains("additionalProperties")) {
                collect(root, node->at("additionalProperties"), next);
            }
            if (node->contains("items")) {
                collect(root, node->at("items"), next);
            }
        }
        nodes = std::move(next);
    }
    return nodes;
}

/// Returns the values of `keyword` in all nodes; arrays are split into their elements.
std::vector<Json> gathered(const std::vector<const Json *> &nodes, const char *keyword) {
    std::vector<Json> values;
    for (const Json *node : nodes) {
        if (node->contains(keyword)) {
            const Json &value = node->at(keyword);
            const std::vector<Json> list =
                value.is_array() ? value.get<std::vector<Json>>() : std::vector{value};
            values.insert(values.end(), list.begin(), list.end());
        }
    }
    return values;
}

std::string listed(const std::vector<Json> &values, const char *separator) {
    std::vector<std::string> words;
    for (const Json &value : values) {
        words.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
    return fmt::format("{}", fmt::join(words, separator));
}

/// Returns a value as it appears in a message: truncated, with invalid UTF-8 replaced.
std::string shown(const Json &value) {
    constexpr size_t longest = 60;
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

/// Explains what is wrong with `value` in terms of the schema, in one or more sentences. The
/// validator reports only the path and a general reason ("could not be validated"), never the legal
/// values. Empty if the schema's terms do not tell.
std::vector<std::string> explain(const Json &value, const std::vector<const Json *> &nodes) {
    const std::vector<Json> types = gathered(nodes, "type");
    if (!types.empty()) {
        bool matches = false;
        for (const Json &type : types) {
            matches = matches || type == value.type_name() ||
                      (type == "integer" && value.is_number_integer()) ||
                      (type == "number" && value.is_number());
        }
        if (!matches) {
            return {fmt::format("{} is not of type {}", shown(value), listed(types, " or "))};
        }
    }
    std::vector<std::string> faults;
    if (value.is_object()) {
        std::vector<Json> allowed;
        bool closed = false;
        for (const Json *node : nodes) {
            closed = closed || (node->contains("additionalProperties") &&
                                node->at("additionalProperties") == false);
            if (node->contains("properties")) {
                for (const auto &property : node->at("properties").items()) {
                    allowed.emplace_back(property.key());
                }
            }
        }
        for (const auto &member : value.items()) {
            if (closed &&
                std::find(allowed.begin(), allowed.end(), member.key()) == allowed.end()) {
                faults.push_back(fmt::format("unknown key '{}'; allowed: {}", member.key(),
                                             listed(allowed, ", ")));
            }
        }
        for (const Json &required : gathered(nodes, "required")) {
            if (!value.contains(required.get<std::string>())) {
                faults.push_back(fmt::format("missing key '{}'", required.get<std::string>()));
                break;  // others may belong to alternatives
            }
        }
    }
    for (const Json &pattern : gathered(nodes, "pattern")) {
        const std::regex expression(pattern.get<std::string>());
        if (value.is_string() && !std::regex_search(value.get<std::string>(), expression)) {
            faults.push_back(
                fmt::format("{} is not of the form {}", shown(value), pattern.get<std::string>()));
        }
    }
    const std::vector<Json> choices = gathered(nodes, "enum");
    if (!choices.empty() && std::find(choices.begin(), choices.end(), value) == choices.end()) {
        faults.push_back(fmt::format("{} is not one of: {}", shown(value), listed(choices, ", ")));
    }
    return faults;
}

/// An error of the validator.
struct LocatedError {
    std::vector<std::string> context;  ///< path of the value
    std::string reason;
    bool is_inner = true;  ///< the value contains no other error
};

/// Returns the errors in the order of their paths. Every enclosing value repeats the errors of its
/// members.
std::vector<LocatedError> located(const valijson::ValidationResults &results) {
    std::map<std::vector<std::string>, std::string> reasons;
    for (const auto &error : results) {
        reasons.emplace(error.context, error.description);
    }
    std::vector<LocatedError> errors;
    for (const auto &[context, reason] : reasons) {
        if (!errors.empty()) {  // a prefix is sorted directly before what it begins
            const std::vector<std::string> &before = errors.back().context;
            errors.back().is_inner = before.size() >= context.size() ||
                                     !std::equal(before.begin(), before.end(), context.begin());
        }
        errors.push_back({context, reason});
    }
    return errors;
}

/// Most errors of a file that one message has. Each one is located by parsing the text again.
constexpr size_t most_errors = 10;

}  // namespace

Json parse_json(const std::string &text, const std::string &source_name) {
    Position position;
    StrictReader reader(source_name, position);
    Json::sax_parse(CountingIterator(text.data(), &position),
                    CountingIterator(text.data() + text.size(), &position), &reader);
    return reader.take();
}

Json load_json(const std::filesystem::path &path) {
    return parse_json(read_file(path), path.string());
}

std::string json_location(const std::string &source_name, const std::string &text,
                          const std::string &pointer) {
    const size_t line = text.empty() ? 0 : line_of(text, pointer);
    std::string location = line > 0 ? fmt::format("{}:{}", source_name, line) : source_name;
    return pointer.empty() ? location : fmt::format("{}: {}", location, pointer);
}

void validate_json(const Json &document, const std::string &schema_text,
                   const std::string &source_name, const std::string &text) {
    const Json schema_document = parse_json(schema_text, "schema of " + source_name);
    valijson::Schema schema;
    valijson::SchemaParser().populateSchema(
        valijson::adapters::NlohmannJsonAdapter(schema_document), schema);

    valijson::ValidationResults results;
    valijson::Validator validator;
    if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &results)) {
        return;
    }
    std::vector<std::string> known, general;  // whether the schema's terms tell what is wrong
    for (const LocatedError &error : located(results)) {
        if (known.size() + general.size() >= 2 * most_errors) {
            break;
        }
        std::vector<std::string> path;
        std::string pointer;
        const Json *value = &document;
        const std::string *name = name_of(document);
        for (size_t i = 1; i < error.context.size(); ++i) {  // [0] is the root
            const std::string &token = error.context[i];     // "[key]"
            path.push_back(token.substr(1, token.size() - 2));
            pointer += "/" + escaped(path.back());
            value =
                value->is_array() ? &value->at(std::stoul(path.back())) : &value->at(path.back());
            name = name_of(*value) != nullptr ? name_of(*value) : name;
        }
        const std::vector<std::string> faults =
            explain(*value, schema_nodes(schema_document, path));
        if (faults.empty() && !error.is_inner) {
            continue;
        }
        const std::string location =
            fmt::format("{}{}", json_location(source_name, text, pointer),
                        name != nullptr ? fmt::format(" (in '{}')", *name) : "");
        for (const std::string &fault : faults) {
            known.push_back(fmt::format("{}: {}", location, fault));
        }
        if (faults.empty()) {
            general.push_back(fmt::format("{}: {}: {}", location, shown(*value), error.reason));
        }
    }
    // Alternatives that were not meant cause general errors beside the known ones.
    std::vector<std::string> &errors = known.empty() ? general : known;
    errors.resize(std::min(errors.size(), most_errors));
    throw input_error(fmt::format("{}", fmt::join(errors, "\n")));
}

}  // namespace rtrays
