// SPDX-License-Identifier: MIT
// What the parts of the scene reader share: where they are in the document, and values by a table.
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

/// The document that a scene is read from.
struct SceneSource {
    const std::string &text;
    const std::string &name;          ///< in messages
    std::filesystem::path directory;  ///< that files are relative to

    /// Runs `body`; an `Error` from it gets source, line and path, the innermost one that is known.
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
    /// An error that already says where.
    struct LocatedError : Error {
        explicit LocatedError(const std::string &message) : Error(ExitCode::bad_input, message) {}
    };
};

Eigen::Vector3d vector3(const Json &value);

/// `value` as the type of the parameter; one number stands for all of two or three equal ones.
/// Throws `Error` (bad input) when it is of another type.
PropertyValue parameter_value(const Json &value, const Parameter &parameter);

/// The members of `object` as values of the parameters of the same name; "type" and those in
/// `others` are somebody else's. Throws `Error` (bad input) with source, line and path for a key
/// that the table does not have, naming `type` and the keys that it has, and for a value that is
/// illegal.
ParameterValues parameter_values(const Json &object, const std::string &type,
                                 const ParameterTable &table,
                                 const std::vector<std::string> &others, const SceneSource &source,
                                 const std::string &path);

/// Throws `Error` (bad input) naming `type` and the key when `object` lacks one of `required` or
/// has one that is neither of them nor in `optional`.
void check_keys(const Json &object, const std::string &type,
                const std::vector<std::string> &required, const std::vector<std::string> &optional);

}  // namespace rtrays
