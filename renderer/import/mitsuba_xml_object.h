// SPDX-License-Identifier: MIT
// An object of a Mitsuba scene (a shape, a BSDF, ...): its typed properties and the objects within
// it.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "renderer/import/mitsuba_xml_document.h"

namespace rtrays::mitsuba {

/// Gives out properties by name and type and remembers which: what nobody asked for is unknown.
class Object {
  public:
    /// Throws `LocatedError` when a property has no name, two have the same, or there is an element
    /// that is neither a property nor an object.
    Object(const Element &element, const Document &document);

    const Element &element() const { return element_; }
    const std::string &type() const { return type_; }
    std::string id() const { return element_.attribute("id"); }

    // Properties. All throw `LocatedError` naming the line when the value is of another type or
    // malformed.

    bool has(const std::string &name);
    double number(const std::string &name, double initial);
    std::optional<double> number(const std::string &name);
    bool boolean(const std::string &name, bool initial);
    std::string text(const std::string &name, const std::string &initial);
    std::optional<std::string> text(const std::string &name);
    std::optional<Eigen::Vector3d> vector(const std::string &name);

    /// The value of a string property as its place in `choices`.
    size_t choice(const std::string &name, const std::vector<std::string> &choices, size_t initial);

    /// A reflectance or another number per channel: a colour, or one number for all.
    std::optional<Eigen::Vector3d> colour(const std::string &name);

    /// What an emitter emits: likewise, but a spectrum of one value is that of illuminant E, which
    /// is not white in Rec. 709.
    Eigen::Vector3d emission(const std::string &name, double initial);

    /// World from object, or the identity.
    Eigen::Matrix4d transform(const std::string &name = "to_world");

    /// Whether the property's tag is `tag`.
    bool is(const std::string &name, const char *tag) const;

    /// The element of a property that is there.
    const Element &property(const std::string &name) const { return properties_.at(name); }

    /// The objects of one tag, references resolved; of those with a name only the ones that are
    /// called `name`.
    std::vector<Element> objects(const std::string &tag, const std::string &name = "");

    /// Asks for a property whose value does not matter.
    void ignore(const std::string &name) { asked_.insert(name); }

    /// Throws `LocatedError` naming the first property or object that nobody asked for and those
    /// that were.
    void finish() const;

  private:
    struct Part {
        Element element;  ///< with references resolved
        std::string name;
        Element place;
    };

    const Element *find(const std::string &name, const std::vector<const char *> &tags,
                        const char *expected);

    Element element_;
    std::string type_;
    std::map<std::string, Element> properties_;
    std::vector<Part> parts_;
    std::set<std::string> asked_;
    std::set<std::pair<std::string, std::string>> asked_parts_;
};

/// Numbers separated by commas or blanks. Throws `LocatedError` when one is malformed or not
/// finite.
std::vector<double> parse_numbers(const Element &element, const std::string &text);

/// The similarity that the transform is but for the digits that a file leaves out (a part in 10^4):
/// so moves what must stay round, or rigid. Throws `Error` (bad input) naming `what` when it shears
/// or stretches.
Eigen::Matrix4d nearest_similarity(const Eigen::Matrix4d &transform, const std::string &what);

/// A "transform" element: its operations in the order written, the first one applied first.
Eigen::Matrix4d parse_transform(const Element &element);

}  // namespace rtrays::mitsuba
