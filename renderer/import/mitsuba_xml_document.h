// SPDX-License-Identifier: MIT
// The XML of a Mitsuba scene: files, parameters ("$name") and identifiers.
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

/// An `Error` that already says where.
struct LocatedError : Error {
    explicit LocatedError(const std::string &message) : Error(ExitCode::bad_input, message) {}
};

using Parameters = std::map<std::string, std::string>;

struct SourceFile {
    std::string name;  ///< in messages
    std::string text;
    std::filesystem::path directory;  ///< that files are relative to
    pugi::xml_document xml;
};

/// An element and where it stands. Refers to its document.
class Element {
  public:
    Element(pugi::xml_node node, const SourceFile &file, const Parameters &parameters)
        : node_(node), file_(&file), parameters_(&parameters) {}

    std::string tag() const { return node_.name(); }
    bool has(const char *attribute) const { return !node_.attribute(attribute).empty(); }

    /// The attribute with its parameters substituted; "" when there is none. Throws `LocatedError`
    /// for a parameter that is not defined.
    std::string attribute(const char *name) const;

    /// As it stands in the file.
    std::string raw_attribute(const char *name) const { return node_.attribute(name).value(); }

    /// The elements below. Throws `LocatedError` when there is text beside them.
    std::vector<Element> children() const;

    /// Throws `LocatedError` for an attribute that is not in `known`.
    void check_attributes(const std::vector<std::string> &known) const;

    std::filesystem::path path(const std::string &file) const { return file_->directory / file; }

    /// "scene.xml:12: <bsdf type="plastic" id="wall">: MESSAGE".
    LocatedError error(const std::string &message) const;

    /// Runs `body`; an `Error` from it that does not say where it comes from gets this element.
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

    /// What tells elements apart.
    size_t hash() const { return node_.hash_value(); }

  private:
    pugi::xml_node node_;
    const SourceFile *file_;
    const Parameters *parameters_;
};

/// A scene file with all that it includes.
class Document {
  public:
    /// Throws `Error` (bad input) naming source and line when the text is no scene of Mitsuba 2
    /// or 3.
    Document(const std::string &text, const std::string &source_name,
             const std::filesystem::path &directory);
    Document(const Document &) = delete;
    Document &operator=(const Document &) = delete;

    /// The elements of the scene, those of included files in place.
    const std::vector<Element> &elements() const { return elements_; }

    /// Throws `LocatedError` naming the identifiers there are when there is none such.
    const Element &referenced(const Element &reference) const;

  private:
    void add_file(SourceFile &file, int depth);
    void add_element(const Element &element, int depth);
    void register_ids(const Element &element);

    std::list<SourceFile> files_;  ///< stay where they are
    Parameters parameters_;
    std::vector<Element> elements_;
    std::map<std::string, Element> ids_;
};

}  // namespace rtrays::mitsuba
