// SPDX-License-Identifier: MIT
// Error locations and table-driven values, shared by the parts of the scene reader.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/scene/parameters.h"

namespace rtrays {

class Scene;

/// The document that a scene is read from.
struct SceneSource {
    const std::string &text;
    const std::string &name;          ///< as shown in messages
    std::filesystem::path directory;  ///< base of relative file names

    /// Runs `body`. Adds source, line and path to an `Error` that has no location yet, so that
    /// messages show the innermost path.
    template <typename Body>
    std::invoke_result_t<Body> located(const std::string &path, const Body &body) const {
        try {
            return body();
        } catch (const LocatedError &) {
            throw;
        } catch (const Error &error) {
            throw LocatedError(json_location(name, text, path) + ": " + error.what());
        }
    }

    std::filesystem::path file(const Json &value) const {
        return directory / value.get<std::string>();
    }

  private:
    /// An error whose message already contains a location.
    struct LocatedError : Error {
        explicit LocatedError(const std::string &message) : Error(ExitCode::bad_input, message) {}
    };
};

Eigen::Vector3d vector3(const Json &value);

/// Sets the properties of a scene that the "set" of the object at `pointer` names, if it has one.
/// Throws `Error` (bad input) naming the line and the address.
void set_properties(Scene &scene, const Json &object, const std::string &pointer,
                    const SceneSource &source);

/// Converts `value` to the type of the parameter. A single number sets all components of a vector
/// of two or three. Throws `Error` (bad input) if the type does not match.
PropertyValue parameter_value(const Json &value, const Parameter &parameter);

/// Reads the members of `object` as values of the parameters of the same name. Skips "type" and the
/// keys in `others`. Throws `Error` (bad input) with source, line and path for an illegal value or
/// an unknown key. The message for an unknown key lists the keys of `type`.
ParameterValues parameter_values(const Json &object, const std::string &type,
                                 const ParameterTable &table,
                                 const std::vector<std::string> &others, const SceneSource &source,
                                 const std::string &path);

/// Throws `Error` (bad input) naming `type` and the key if `object` lacks a required key, or if it
/// has a key that is neither required nor optional. The key "type" is always allowed.
void check_keys(const Json &object, const std::string &type,
                const std::vector<std::string> &required, const std::vector<std::string> &optional);

}  // namespace rtrays
