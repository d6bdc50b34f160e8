// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/object.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "renderer/base/files.h"
#include "renderer/base/lower_case.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector3d;

constexpr const char *property_tags[] = {"float",  "integer", "boolean", "string",   "point",
                                         "vector", "rgb",     "srgb",    "spectrum", "transform"};
constexpr const char *object_tags[] = {"bsdf",    "texture", "emitter", "film",
                                       "sampler", "rfilter", "shape"};

template <typename Table>
bool contains(const Table &table, const std::string &value) {
    return std::find(std::begin(table), std::end(table), value) != std::end(table);
}

double srgb_channel(const Element &element, double value) {
    if (value < 0 || value > 1) {
        throw element.error(
            fmt::format("{} is not within [0, 1], where the sRGB curve is defined", value));
    }
    return srgb_decoded(value);
}

/// Parses "#rrggbb". Decodes the channels by the sRGB curve if `is_srgb`.
Vector3d hexadecimal(const Element &element, const std::string &text, bool is_srgb) {
    uint32_t value = 0;
    const char *end = text.data() + text.size();
    const auto [at, failure] = std::from_chars(text.data() + 1, end, value, 16);
    if (text.size() != 7 || failure != std::errc() || at != end) {
        throw element.error(fmt::format("expected a colour of the form #rrggbb, got '{}'", text));
    }
    Vector3d colour;
    for (int i = 0; i < 3; ++i) {
        const double channel = ((value >> (16 - 8 * i)) & 255u) / 255.0;
        colour[i] = is_srgb ? srgb_decoded(channel) : channel;
    }
    return colour;
}

/// Returns the numbers in a file of spectral data, one pair of wavelength and value per line.
std::string spectrum_file(const Element &element) {
    if (element.has("value")) {
        throw element.error("has both 'value' and 'filename'; give one");
    }
    const std::filesystem::path path = element.included_path(element.attribute("filename"));
    std::istringstream lines(element.located([&] { return read_file(path); }));
    std::string numbers;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] != '#') {
            numbers += line + '\n';
        }
    }
    return numbers;
}

}  // namespace

std::vector<double> parse_numbers(const Element &element, const std::string &text) {
    std::vector<double> numbers;
    const char *at = text.data();
    const char *const end = at + text.size();
    const auto separates = [](char c) {
        return c == ',' || c == ' ' || c == '\t' || c == '\n' || c == '\r';
    };
    while (true) {
        while (at != end && separates(*at)) {
            ++at;
        }
        if (at == end) {
            return numbers;
        }
        // std::from_chars does not accept a plus sign.
        const bool has_plus = *at == '+' && at + 1 != end && at[1] != '-';
        double value = 0;
        const auto [next, failure] = std::from_chars(has_plus ? at + 1 : at, end, value);
        if (failure != std::errc() || (next != end && !separates(*next)) || !std::isfinite(value)) {
            throw element.error(fmt::format("expected finite numbers, got '{}'", text));
        }
        numbers.push_back(value);
        at = next;
    }
}

Object::Object(const Element &element, const Document &document)
    : element_(element), document_(&document), type_(element.attribute("type")) {
    element.check_attributes({"type", "id", "name"});
    if (type_.empty()) {
        throw element.error("needs a type");
    }
    const auto name_of = [&](const Element &child) {
        const std::string name = child.property_name();
        // Mitsuba renames this property of old files, too.
        const bool renamed = child.is_old() && type_ == "diffuse" && name == "diffuse_reflectance";
        return renamed ? "reflectance" : name;
    };
    for (const Element &child : element.children()) {
        const std::string tag = child.tag();
        if (tag == "ref") {
            child.check_attributes({"id", "name"});
            parts_.push_back({document.referenced(child), name_of(child), child});
        } else if (contains(object_tags, tag)) {
            parts_.push_back({child, name_of(child), child});
        } else if (contains(property_tags, tag)) {
            const std::string name = name_of(child);
            if (name.empty()) {
                throw child.error("needs a name");
            }
            if (!properties_.emplace(name, child).second) {
                throw child.error(fmt::format("duplicate property '{}'", name));
            }
            const bool has_content = tag == "transform" || (tag == "spectrum" && child.has("type"));
            if (!has_content && !child.children().empty()) {
                throw child.error("this property must not contain elements");
            }
        } else {
            throw child.error(fmt::format(
                "unexpected element in <{}>; expected a property ({}), an object ({}) or a ref",
                element.tag(), fmt::join(property_tags, ", "), fmt::join(object_tags, ", ")));
        }
    }
}

const Element *Object::find(const std::string &name, const std::vector<const char *> &tags,
                            const char *expected) {
    asked_.insert(name);
    const auto found = properties_.find(name);
    if (found == properties_.end()) {
        const bool is_object = std::any_of(parts_.begin(), parts_.end(),
                                           [&](const Part &part) { return part.name == name; });
        if (is_object) {
            throw element_.error(fmt::format("'{}' must be {}", name, expected));
        }
        return nullptr;
    }
    const Element &property = found->second;
    if (!contains(tags, property.tag())) {
        throw property.error(
            fmt::format("must be {}: <{} name=\"{}\" .../>", expected, tags.front(), name));
    }
    property.check_attributes(
        property.tag() == "point" || property.tag() == "vector"
            ? std::vector<std::string>{"name", "value", "x", "y", "z"}
        : property.tag() == "transform" ? std::vector<std::string>{"name"}
        : property.tag() == "spectrum"
            ? std::vector<std::string>{"name", "value", "filename", "type", "id"}
            : std::vector<std::string>{"name", "value"});
    return &property;
}

bool Object::has(const std::string &name) {
    asked_.insert(name);
    return properties_.count(name) != 0;
}

bool Object::is(const std::string &name, const char *tag) const {
    const auto found = properties_.find(name);
    return found != properties_.end() && found->second.tag() == tag;
}

std::optional<double> Object::number(const std::string &name) {
    const Element *found = find(name, {"float", "integer"}, "a number");
    if (found == nullptr) {
        return std::nullopt;
    }
    const std::vector<double> numbers = parse_numbers(*found, found->attribute("value"));
    if (numbers.size() != 1) {
        throw found->error("expected one number");
    }
    return numbers[0];
}

double Object::number(const std::string &name, double initial) {
    return number(name).value_or(initial);
}

bool Object::boolean(const std::string &name, bool initial) {
    const Element *found = find(name, {"boolean"}, "true or false");
    if (found == nullptr) {
        return initial;
    }
    const std::string value = in_lower_case(found->attribute("value"));
    if (value != "true" && value != "false") {
        throw found->error(
            fmt::format("expected true or false, got '{}'", found->attribute("value")));
    }
    return value == "true";
}

std::optional<std::string> Object::text(const std::string &name) {
    const Element *found = find(name, {"string"}, "text");
    return found == nullptr ? std::nullopt : std::make_optional(found->attribute("value"));
}

std::string Object::text(const std::string &name, const std::string &initial) {
    return text(name).value_or(initial);
}

size_t Object::choice(const std::string &name, const std::vector<std::string> &choices,
                      size_t initial) {
    const std::string value = text(name, choices[initial]);
    const auto found = std::find(choices.begin(), choices.end(), value);
    if (found == choices.end()) {
        throw property(name).error(
            fmt::format("unknown value '{}'; values are: {}", value, fmt::join(choices, ", ")));
    }
    return static_cast<size_t>(found - choices.begin());
}

std::optional<Vector3d> Object::vector(const std::string &name) {
    const Element *found = find(name, {"point", "vector"}, "three coordinates");
    if (found == nullptr) {
        return std::nullopt;
    }
    if (found->has("value")) {
        const std::vector<double> numbers = parse_numbers(*found, found->attribute("value"));
        const bool is_valid = numbers.size() == 3 || numbers.size() == 1;
        if (!is_valid || found->has("x") || found->has("y") || found->has("z")) {
            throw found->error("expected three numbers");
        }
        return Vector3d(numbers.front(), numbers[numbers.size() / 2], numbers.back());
    }
    Vector3d result;
    constexpr const char *axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        const std::vector<double> numbers = parse_numbers(*found, found->attribute(axes[i]));
        if (numbers.size() != 1) {
            throw found->error(fmt::format("expected one number as {}", axes[i]));
        }
        result[i] = numbers[0];
    }
    return result;
}

Vector3d Object::typed_spectrum(const Element &element, SpectrumUse use) const {
    Object spectrum(element, *document_);
    Vector3d value;
    if (spectrum.type() == "d65") {  // white in Rec. 709
        const Vector3d colour = spectrum.colour("color").value_or(Vector3d::Ones());
        value = spectrum.number("scale", 1) * colour;
    } else if (spectrum.type() == "srgb") {
        value = spectrum.colour("color").value_or(Vector3d::Ones());
    } else if (spectrum.type() == "uniform") {
        value = Vector3d::Constant(spectrum.number("value", 1));
    } else if (spectrum.type() == "blackbody") {
        const std::optional<double> temperature = spectrum.number("temperature");
        if (use != SpectrumUse::emission || !temperature.has_value() || !(*temperature > 0)) {
            throw element.error("expected a positive temperature, for an emission");
        }
        value = spectrum_colour(blackbody(*temperature), use);
    } else {
        throw element.error(
            "unsupported spectrum type; supported types are: blackbody, d65, srgb, uniform");
    }
    spectrum.finish();
    return value;
}

Vector3d Object::spectrum(const Element &element, SpectrumUse use) const {
    if (element.has("type")) {
        return typed_spectrum(element, use);
    }
    std::string text = element.attribute("value");
    const auto pairs = std::count(text.begin(), text.end(), ':');
    if (element.has("filename")) {
        text = spectrum_file(element);
    } else if (pairs == 0) {
        const std::vector<double> numbers = parse_numbers(element, text);
        if (numbers.size() != 1) {
            throw element.error("expected one number, or pairs WAVELENGTH:VALUE");
        }
        return numbers[0] *
               (use == SpectrumUse::emission ? illuminant_e() : Vector3d(Vector3d::Ones()));
    }
    std::replace(text.begin(), text.end(), ':', ' ');
    const std::vector<double> numbers = parse_numbers(element, text);
    if (numbers.size() % 2 != 0 ||
        (pairs != 0 && numbers.size() != 2 * static_cast<size_t>(pairs))) {
        throw element.error("expected pairs WAVELENGTH:VALUE");
    }
    Spectrum measured;
    for (size_t i = 0; i < numbers.size(); i += 2) {
        measured.wavelengths.push_back(numbers[i]);
        measured.values.push_back(numbers[i + 1]);
    }
    return element.located([&] { return spectrum_colour(measured, use); });
}

std::optional<Vector3d> Object::colour(const std::string &name, SpectrumUse use) {
    const Element *found = find(name, {"rgb", "srgb", "spectrum", "float", "integer"}, "a colour");
    if (found == nullptr) {
        return std::nullopt;
    }
    const std::string tag = found->tag();
    if (tag == "spectrum") {
        return spectrum(*found, use);
    }
    const std::string value = found->attribute("value");
    const bool is_colour = tag == "rgb" || tag == "srgb";
    const bool has_hexadecimal = tag == "srgb" || (tag == "rgb" && found->is_old());
    if (has_hexadecimal && !value.empty() && value[0] == '#') {
        // Mitsuba 0.6 takes the digits of <rgb> as linear.
        return hexadecimal(*found, value, tag == "srgb");
    }
    const std::vector<double> numbers = parse_numbers(*found, value);
    if (numbers.size() != 1 && !(is_colour && numbers.size() == 3)) {
        throw found->error(is_colour ? "expected three numbers, or one" : "expected one number");
    }
    Vector3d colour = numbers.size() == 1 ? Vector3d(Vector3d::Constant(numbers[0]))
                                          : Vector3d(numbers[0], numbers[1], numbers[2]);
    if (tag == "srgb") {
        colour = colour.unaryExpr([&](double channel) { return srgb_channel(*found, channel); });
    }
    return colour;
}

Vector3d Object::emission(const std::string &name, double initial) {
    return colour(name, SpectrumUse::emission).value_or(Vector3d::Constant(initial));
}

Eigen::Matrix4d Object::transform(const std::string &name) {
    const Element *found = find(name, {"transform"}, "a transform");
    return found == nullptr ? Eigen::Matrix4d(Eigen::Matrix4d::Identity())
                            : parse_transform(*found);
}

std::vector<Element> Object::objects(const std::string &tag, const std::string &name) {
    asked_parts_.emplace(tag, name);
    std::vector<Element> found;
    for (const Part &part : parts_) {
        if (part.element.tag() == tag && (name.empty() || part.name == name)) {
            found.push_back(part.element);
        }
    }
    return found;
}

bool Object::shows_texture(int depth) const {
    return depth > 0 && std::any_of(parts_.begin(), parts_.end(), [&](const Part &part) {
               const std::string tag = part.element.tag();
               return tag == "texture" ||
                      ((tag == "bsdf" || tag == "emitter") &&
                       Object(part.element, *document_).shows_texture(depth - 1));
           });
}

void Object::finish() const {
    ErrorList errors;
    for (const auto &[name, property] : properties_) {
        if (asked_.count(name) == 0) {
            errors.collect([&, &property = property]() -> void {
                throw property.error(fmt::format(
                    "unknown property of {} type '{}'; properties are: {}", element_.tag(), type_,
                    asked_.empty() ? "none" : fmt::format("{}", fmt::join(asked_, ", "))));
            });
        }
    }
    for (const Part &part : parts_) {
        const std::string tag = part.element.tag();
        if (asked_parts_.count({tag, ""}) == 0 && asked_parts_.count({tag, part.name}) == 0) {
            errors.collect([&]() -> void {
                throw part.place.error(
                    fmt::format("{} type '{}' accepts no {}{}", element_.tag(), type_, tag,
                                part.name.empty() ? "" : " as '" + part.name + "'"));
            });
        }
    }
    errors.raise(element_.source_name());
}

}  // namespace rtrays::mitsuba
