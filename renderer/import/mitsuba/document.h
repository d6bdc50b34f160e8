// SPDX-License-Identifier: MIT
// The XML of a Mitsuba scene: its files, parameters ("$name") and identifiers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "renderer/base/error.h"

namespace rtrays::mitsuba {

/// An `Error` whose message already contains a location.
struct LocatedError : Error {
    explicit LocatedError(const std::string &message) : Error(ExitCode::bad_input, message) {}
};

using Parameters = std::map<std::string, std::string>;

struct SourceFile {
    std::string name;  ///< as shown in messages
    std::string text;
    std::filesystem::path directory;  ///< base of relative file names
    pugi::xml_document xml;
};

/// An element and its location. Refers to its document, which must outlive it.
class Element {
  public:
    Element(pugi::xml_node node, const SourceFile &file, const Parameters &parameters)
        : node_(node), file_(&file), parameters_(&parameters) {}

    std::string tag() const { return node_.name(); }
    bool has(const char *attribute) const { return !node_.attribute(attribute).empty(); }

    /// Returns the attribute with its parameters substituted, or "" if it is missing. Throws
    /// `LocatedError` for an undefined parameter.
    std::string attribute(const char *name) const;

    /// Returns the attribute as written in the file, or "" if it is missing.
    std::string raw_attribute(const char *name) const { return node_.attribute(name).value(); }

    /// Returns the child elements. Throws `LocatedError` if there is text between them.
    std::vector<Element> children() const;

    /// Throws `LocatedError` for an attribute that is not in `known`.
    void check_attributes(const std::vector<std::string> &known) const;

    std::filesystem::path path(const std::string &file) const { return file_->directory / file; }

    /// Returns the error "scene.xml:12: <bsdf type="plastic" id="wall">: MESSAGE".
    LocatedError error(const std::string &message) const;

    /// Runs `body`. Adds the location of this element to an `Error` that has none.
    template <typename Body>
    std::invoke_result_t<Body> located(const Body &body) const {
        try {
            return body();
        } catch (const LocatedError &) {
            throw;
        } catch (const Error &failure) {
            throw error(failure.what());
        }
    }

    /// Returns a value that identifies the element.
    size_t hash() const { return node_.hash_value(); }

  private:
    pugi::xml_node node_;
    const SourceFile *file_;
    const Parameters *parameters_;
};

/// A scene file together with all included files.
class Document {
  public:
    /// Throws `Error` (bad input) naming source and line unless the text is a scene of Mitsuba 2
    /// or 3.
    Document(const std::string &text, const std::string &source_name,
             const std::filesystem::path &directory);
    Document(const Document &) = delete;
    Document &operator=(const Document &) = delete;

    /// Returns the elements of the scene. Elements of an included file replace the include.
    const std::vector<Element> &elements() const { return elements_; }

    /// Returns the element that a "ref" names. Throws `LocatedError` that lists the known
    /// identifiers if the reference is unknown.
    const Element &referenced(const Element &reference) const;

  private:
    void add_file(SourceFile &file, int depth);
    void add_element(const Element &element, int depth);
    void register_ids(const Element &element);

    std::list<SourceFile> files_;  ///< a list, because elements hold their addresses
    Parameters parameters_;
    std::vector<Element> elements_;
    std::map<std::string, Element> ids_;
};

}  // namespace rtrays::mitsuba
