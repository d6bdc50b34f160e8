// SPDX-License-Identifier: MIT
// Embedded sources of the device programs and the expansion of their includes.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace rtrays {

/// Replacement texts of kernel sources by path ("kernels/light/area_light.h"). Tests use them to
/// plant errors, so that the shipped code needs no test hooks.
using SourceOverlays = std::map<std::string, std::string>;

/// Returns the text of an embedded device source, for instance "kernels/bsdf/bsdf.h" or
/// "shared/compat.h". Throws `Error` (run failed) that names the path when it does not exist.
std::string device_source(const std::string &path);

/// Returns the texts of `paths` in a row, with every `#include "..."` expanded recursively.
/// Includes are relative to the including file, then to the roots (renderer/ and the directory of
/// Random123). Files with `#pragma once` are expanded once. Each piece is preceded by `#line` with
/// its own path, so that compiler messages name the real file. `#include <...>` is left alone. An
/// include that cannot be resolved becomes an `#error` that names file and line; it fails the build
/// unless its branch is not compiled. Throws `Error` (run failed) when one of `paths` does not
/// exist.
std::string expand_source(const std::vector<std::string> &paths,
                          const SourceOverlays &overlays = {});

/// Returns "FILE:LINE" for a line (counted from 1) of a text that `expand_source` returned, and
/// "defines:LINE" for lines before its first `#line`.
std::string source_place(const std::string &expanded, size_t line);

}  // namespace rtrays
