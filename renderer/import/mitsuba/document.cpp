// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "renderer/base/files.h"

namespace rtrays::mitsuba {

namespace {

constexpr int deepest_include = 16;
constexpr int deepest_element = 64;
constexpr const char *tags_with_id[] = {"bsdf",       "texture", "shape",   "emitter",
                                        "sensor",     "film",    "sampler", "rfilter",
                                        "integrator", "medium",  "phase",   "volume"};

size_t line_of(const std::string &text, ptrdiff_t offset) {
    const auto end = std::min(static_cast<size_t>(std::max<ptrdiff_t>(offset, 0)), text.size());
    return 1 + static_cast<size_t>(
                   std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(end), '\n'));
}

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
}

bool is_lower(char c) {
    return std::islower(static_cast<unsigned char>(c)) != 0;
}

bool is_upper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

std::string snake_case(const std::string &name) {
    std::string result;
    for (size_t i = 0; i < name.size(); ++i) {
        if (i == 0 || !is_lower(name[i - 1]) || !is_upper(name[i])) {
            result += name[i];
            continue;
        }
        result += '_';
        for (; i < name.size() && is_upper(name[i]); ++i) {  // "intIOR" is "int_ior"
            result += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
        }
        --i;
    }
    return result;
}

std::string Element::attribute(const char *name) const {
    const std::string raw = raw_attribute(name);
    std::string value;
    for (size_t i = 0; i < raw.size();) {
        if (raw[i] != '$') {
            value += raw[i++];
            continue;
        }
        // The longest defined name wins: "$resx_large" may be "$resx" and "_large".
        size_t end = i + 1;
        while (end < raw.size() && is_name_character(raw[end])) {
            ++end;
        }
        const std::string whole = raw.substr(i + 1, end - i - 1);
        size_t length = whole.size();
        while (length > 0 && parameters_->count(whole.substr(0, length)) == 0) {
            --length;
        }
        if (length == 0) {
            throw error(
                fmt::format("undefined parameter '${}'; add <default name=\"{}\" value=\"...\"/>",
                            whole, whole));
        }
        value += parameters_->at(whole.substr(0, length));
        i += 1 + length;
    }
    return value;
}

std::vector<Element> Element::children() const {
    std::vector<Element> all;
    for (const pugi::xml_node child : node_.children()) {
        if (child.type() == pugi::node_element) {
            all.emplace_back(child, *file_, *parameters_);
        } else if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
            throw error(fmt::format("unexpected text '{}'; expected elements", child.value()));
        }
    }
    return all;
}

void Element::check_attributes(const std::vector<std::string> &known) const {
    std::vector<std::string> met;
    for (const pugi::xml_attribute attribute : node_.attributes()) {
        if (std::find(known.begin(), known.end(), attribute.name()) == known.end()) {
            throw error(fmt::format("unknown attribute '{}'; attributes are: {}", attribute.name(),
                                    fmt::join(known, ", ")));
        }
        if (std::find(met.begin(), met.end(), attribute.name()) != met.end()) {
            throw error(fmt::format("duplicate attribute '{}'", attribute.name()));
        }
        met.emplace_back(attribute.name());
    }
}

std::filesystem::path Element::found_in(const std::vector<std::filesystem::path> &folders,
                                        const std::string &file) const {
    std::string tried;
    for (const std::filesystem::path &folder : folders) {
        const std::filesystem::path path = folder / file;  // `file`, if that is absolute
        std::error_code failure;
        if (std::filesystem::exists(path, failure)) {
            return path;
        }
        tried += (tried.empty() ? "'" : ", '") + (folder.empty() ? "." : folder.string()) + "'";
    }
    throw error(fmt::format("cannot find '{}'; searched folders: {}", file, tried));
}

LocatedError Element::error(const std::string &message) const {
    std::string shown = "<" + tag();
    for (const char *attribute : {"type", "name", "id"}) {
        if (has(attribute)) {
            shown += fmt::format(" {}=\"{}\"", attribute, raw_attribute(attribute));
        }
    }
    return LocatedError(fmt::format("{}:{}: {}>: {}", file_->name,
                                    line_of(file_->text, node_.offset_debug()), shown, message));
}

Document::Document(const std::string &text, const std::string &source_name,
                   const std::filesystem::path &directory, const Parameters &defines)
    : parameters_(defines) {
    SourceFile &file = files_.emplace_back();
    file.name = source_name;
    file.text = text;
    file.folders = {directory};
    file.top = &file;
    add_file(file, 0);
    errors_.collect([&] { check_defines(defines); });
    errors_.raise(source_name);
}

void Document::check_defines(const Parameters &defines) const {
    for (const auto &[name, value] : defines) {
        const bool used =
            std::any_of(files_.begin(), files_.end(), [&, &name = name](const SourceFile &file) {
                return file.text.find('$' + name) != std::string::npos;
            });
        if (!used) {
            throw LocatedError(
                fmt::format("{}: parameter '{}' is defined, but the file does not "
                            "use ${}",
                            files_.front().name, name, name));
        }
    }
}

void Document::add_file(SourceFile &file, int depth) {
    // Document types are not parsed, because their entities could grow without bound.
    const pugi::xml_parse_result result =
        file.xml.load_buffer(file.text.data(), file.text.size(), pugi::parse_default);
    const auto fail = [&](ptrdiff_t offset, const std::string &message) {
        return LocatedError(
            fmt::format("{}:{}: {}", file.name, line_of(file.text, offset), message));
    };
    if (!result) {
        throw fail(result.offset, fmt::format("not well-formed XML: {}", result.description()));
    }
    // pugixml accepts several root elements.
    const pugi::xml_node root = file.xml.document_element();
    for (const pugi::xml_node node : file.xml.children()) {
        if (node != root && node.type() == pugi::node_element) {
            throw fail(
                node.offset_debug(),
                fmt::format("second root element <{}>; a file has one <scene>", node.name()));
        }
    }
    if (std::string(root.name()) != "scene") {
        throw fail(root.offset_debug(),
                   fmt::format("expected the root element <scene>, got <{}>", root.name()));
    }
    const Element scene(root, file, parameters_);
    check_version(scene, file);
    for (const Element &element : scene.children()) {
        if (depth == 0) {
            errors_.collect([&] { add_element(element, file, depth); });
        } else {  // one error per include, so that nested includes cannot repeat it without bound
            add_element(element, file, depth);
        }
    }
}

void Document::check_version(const Element &scene, SourceFile &file) {
    scene.check_attributes({"version"});
    const std::string version = scene.attribute("version");
    int major = -1;
    std::from_chars(version.data(), version.data() + version.size(), major);
    if (major < 0 || major > 3) {
        throw scene.error(fmt::format(
            "unsupported version '{}'; expected a version of Mitsuba from 0.4.0 to 3", version));
    }
    file.is_old = major < 2;
}

void Document::add_element(const Element &element, SourceFile &file, int depth) {
    const std::string tag = element.tag();
    if (tag == "default") {
        add_default(element);
    } else if (tag == "include") {
        include(element, file, depth);
    } else if (tag == "path") {
        add_folder(element, file);
    } else if (tag == "alias") {
        add_alias(element);
    } else {
        register_ids(element);
        elements_.push_back(element);
    }
}

void Document::add_default(const Element &element) {
    element.check_attributes({"name", "value"});
    const std::string name = element.attribute("name");
    if (name.empty() || !element.has("value") ||
        !std::all_of(name.begin(), name.end(), is_name_character)) {
        throw element.error("needs a name (letters, digits, - and _) and a value");
    }
    parameters_.emplace(name, element.attribute("value"));  // the first definition wins
}

void Document::include(const Element &element, const SourceFile &file, int depth) {
    element.check_attributes({"filename"});
    if (depth == deepest_include) {
        throw element.error(
            fmt::format("includes are nested deeper than {} files", deepest_include));
    }
    const std::filesystem::path path = element.included_path(element.attribute("filename"));
    SourceFile &included = files_.emplace_back();
    included.name = path.string();
    included.text = element.located([&] { return read_file(path); });
    included.folders = file.folders;
    included.folders.insert(included.folders.begin(), path.parent_path());
    included.top = file.top;
    add_file(included, depth + 1);
}

void Document::add_folder(const Element &element, SourceFile &file) {
    element.check_attributes({"value"});
    const std::filesystem::path folder = element.included_path(element.attribute("value"));
    std::error_code failure;
    if (!std::filesystem::is_directory(folder, failure)) {
        throw element.error(fmt::format("'{}' is not a folder", folder.string()));
    }
    file.folders.insert(file.folders.begin(), folder);
}

void Document::add_alias(const Element &element) {
    element.check_attributes({"id", "as"});
    const std::string name = element.attribute("as");
    if (!ids_.emplace(name, referenced(element)).second) {
        throw element.error(fmt::format("duplicate id '{}'", name));
    }
}

void Document::register_ids(const Element &element) {
    // Without recursion, because the file determines the depth of its elements.
    std::vector<std::pair<Element, int>> pending{{element, 0}};
    while (!pending.empty()) {
        const auto [next, level] = pending.back();
        pending.pop_back();
        if (level > deepest_element) {
            throw next.error(
                fmt::format("elements are nested deeper than {} levels", deepest_element));
        }
        const std::string tag = next.tag();
        const bool may_have_id = std::find(std::begin(tags_with_id), std::end(tags_with_id), tag) !=
                                 std::end(tags_with_id);
        if (may_have_id && next.has("id")) {
            const std::string id = next.attribute("id");
            const auto [found, is_new] = ids_.emplace(id, next);
            if (!is_new) {
                throw next.error(fmt::format("duplicate id '{}'", id));
            }
        }
        for (const Element &child : next.children()) {
            pending.emplace_back(child, level + 1);
        }
    }
}

const Element &Document::referenced(const Element &reference) const {
    const std::string id = reference.attribute("id");
    const auto found = ids_.find(id);
    if (found == ids_.end()) {
        std::vector<std::string> ids;
        for (const auto &entry : ids_) {
            ids.push_back(entry.first);
        }
        throw reference.error(
            fmt::format("unknown id '{}'; ids are: {}", id,
                        ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ", "))));
    }
    return found->second;
}

}  // namespace rtrays::mitsuba
