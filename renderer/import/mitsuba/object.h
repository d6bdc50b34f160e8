// SPDX-License-Identifier: MIT
// Typed properties and nested objects of an object of a Mitsuba scene (a shape, a BSDF, ...).
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "renderer/import/mitsuba/document.h"
#include "renderer/import/mitsuba/spectrum.h"

namespace rtrays::mitsuba {

/// Returns properties by name and type, and records which names were requested. `finish` reports
/// every other property as unknown.
class Object {
  public:
    /// Throws `LocatedError` if a property has no name, if two properties have the same name, or if
    /// an element is neither a property nor an object.
    Object(const Element &element, const Document &document);

    const Element &element() const { return element_; }
    const std::string &type() const { return type_; }
    std::string id() const { return element_.attribute("id"); }

    // Properties. Each function throws `LocatedError` naming the line if the value is malformed or
    // has another type.

    bool has(const std::string &name);
    double number(const std::string &name, double initial);
    std::optional<double> number(const std::string &name);
    bool boolean(const std::string &name, bool initial);
    std::string text(const std::string &name, const std::string &initial);
    std::optional<std::string> text(const std::string &name);
    std::optional<Eigen::Vector3d> vector(const std::string &name);

    /// Returns the index in `choices` of a string property's value.
    size_t choice(const std::string &name, const std::vector<std::string> &choices, size_t initial);

    /// Returns a value per channel. The file gives a colour, one number for all channels, or a
    /// spectrum, which is reduced to three channels as in Mitsuba's RGB variants (spectrum.h).
    std::optional<Eigen::Vector3d> colour(const std::string &name,
                                          SpectrumUse use = SpectrumUse::reflectance);

    /// Returns an emitted radiance or power per channel. Unlike in `colour`, a <spectrum> of one
    /// number is that multiple of illuminant E, which is not white in Rec. 709.
    Eigen::Vector3d emission(const std::string &name, double initial);

    /// Returns the transform from object to world space, or the identity if it is missing.
    Eigen::Matrix4d transform(const std::string &name = "to_world");

    /// Returns whether the property is present and its tag is `tag`.
    bool is(const std::string &name, const char *tag) const;

    /// Returns the element of a property that must be present.
    const Element &property(const std::string &name) const { return properties_.at(name); }

    /// Returns the nested objects that have this tag, with references resolved. If `name` is not
    /// empty, returns only those of that name.
    std::vector<Element> objects(const std::string &tag, const std::string &name = "");

    /// Returns whether a texture is nested in the object, directly or in its BSDFs and emitters. Up
    /// to `depth` levels are searched, because BSDFs may refer to themselves by mistake.
    bool shows_texture(int depth = 6) const;

    /// Accepts a property whose value has no effect.
    void ignore(const std::string &name) { asked_.insert(name); }

    /// Throws `LocatedError` if properties or nested objects were never requested. The message
    /// lists the known properties.
    void finish() const;

  private:
    struct Part {
        Element element;  ///< the object, with references resolved
        std::string name;
        Element place;  ///< the element in this object: the object itself, or a reference
    };

    const Element *find(const std::string &name, const std::vector<const char *> &tags,
                        const char *expected);
    Eigen::Vector3d spectrum(const Element &element, SpectrumUse use) const;
    Eigen::Vector3d typed_spectrum(const Element &element, SpectrumUse use) const;

    Element element_;
    const Document *document_;
    std::string type_;
    std::map<std::string, Element> properties_;
    std::vector<Part> parts_;
    std::set<std::string> asked_;
    std::set<std::pair<std::string, std::string>> asked_parts_;
};

/// Parses numbers separated by commas or white space. Throws `LocatedError` if one is malformed or
/// not finite.
std::vector<double> parse_numbers(const Element &element, const std::string &text);

/// Returns the similarity that a transform equals up to rounding in the file (a part in 10^4).
/// Round shapes and rigid objects require similarities. Throws `Error` (bad input) naming `what` if
/// the transform shears or stretches.
Eigen::Matrix4d nearest_similarity(const Eigen::Matrix4d &transform, const std::string &what);

/// Returns the frame (columns s, t, n) that Mitsuba builds around a unit vector (Duff et al. 2017,
/// "Building an orthonormal basis, revisited").
Eigen::Matrix3d frame_around(const Eigen::Vector3d &n);

/// Parses a "transform" element. Its operations are applied in the order of the file.
Eigen::Matrix4d parse_transform(const Element &element);

}  // namespace rtrays::mitsuba
