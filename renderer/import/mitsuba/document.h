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

#include "renderer/import/mitsuba/error_list.h"

namespace rtrays::mitsuba {

/// Values of the parameters of a scene file, by name.
using Parameters = std::map<std::string, std::string>;

struct SourceFile {
    std::string name;  ///< as shown in messages
    std::string text;
    /// Folders that are searched for relative file names, in this order: those of "path" elements,
    /// the last one first, then the folder of the file, then the folders of the including file.
    std::vector<std::filesystem::path> folders;
    const SourceFile *top = nullptr;  ///< the file that includes all others
    bool is_old = false;              ///< of a version before 2, with names such as "toWorld"
    pugi::xml_document xml;
};

/// Returns a property name of versions before 2, such as "toWorld", as later versions spell it.
std::string snake_case(const std::string &name);

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

    /// Returns the attribute "name" with its parameters substituted and as versions 2 and 3 spell
    /// it.
    std::string property_name() const {
        const std::string name = attribute("name");
        return file_->is_old ? snake_case(name) : name;
    }

    /// Returns whether the file is of a version before 2.
    bool is_old() const { return file_->is_old; }

    /// Returns the child elements. Throws `LocatedError` if there is text between them.
    std::vector<Element> children() const;

    /// Throws `LocatedError` for an attribute that is not in `known`.
    void check_attributes(const std::vector<std::string> &known) const;

    /// Returns the path of a mesh or an image. Like Mitsuba, searches the folders of the top file,
    /// also for elements of included files. Throws `LocatedError` that lists the folders if there
    /// is no such file.
    std::filesystem::path path(const std::string &file) const {
        return found_in(file_->top->folders, file);
    }

    /// Returns the path of an included file or of spectral data. Searches the folders of the
    /// element's own file.
    std::filesystem::path included_path(const std::string &file) const {
        return found_in(file_->folders, file);
    }

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

    const std::string &source_name() const { return file_->name; }

    /// Returns a value that identifies the element.
    size_t hash() const { return node_.hash_value(); }

  private:
    std::filesystem::path found_in(const std::vector<std::filesystem::path> &folders,
                                   const std::string &file) const;

    pugi::xml_node node_;
    const SourceFile *file_;
    const Parameters *parameters_;
};

/// A scene file together with all included files.
class Document {
  public:
    /// Parses a scene of Mitsuba 0.4 to 3. `defines` precede the "default" elements of the file.
    /// Throws `LocatedError` naming source and line for text that is no such scene, and for
    /// parameters in `defines` that no file uses.
    Document(const std::string &text, const std::string &source_name,
             const std::filesystem::path &directory, const Parameters &defines = {});
    Document(const Document &) = delete;
    Document &operator=(const Document &) = delete;

    /// Returns the elements of the scene. Elements of an included file replace the include.
    const std::vector<Element> &elements() const { return elements_; }

    /// Returns the element that a "ref" names. Throws `LocatedError` that lists the known
    /// identifiers if the reference is unknown.
    const Element &referenced(const Element &reference) const;

  private:
    void add_file(SourceFile &file, int depth);
    void check_version(const Element &scene, SourceFile &file);
    void add_element(const Element &element, SourceFile &file, int depth);
    void add_default(const Element &element);
    void add_folder(const Element &element, SourceFile &file);
    void add_alias(const Element &element);
    void include(const Element &element, const SourceFile &file, int depth);
    void register_ids(const Element &element);
    void check_defines(const Parameters &defines) const;

    ErrorList errors_;
    std::list<SourceFile> files_;  ///< a list, because elements hold their addresses
    Parameters parameters_;
    std::vector<Element> elements_;
    std::map<std::string, Element> ids_;
};

}  // namespace rtrays::mitsuba
