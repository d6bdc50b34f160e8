// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace rtrays {

/// Replaced kernel sources by path ("kernels/light/area_light.h"): how tests plant errors without a
/// trace of them in the shipped code.
using SourceOverlays = std::map<std::string, std::string>;

/// The text of an embedded device source, for instance "kernels/bsdf/bsdf.h" or "shared/compat.h".
/// Throws `Error` (run failed) naming it when there is none.
std::string device_source(const std::string &path);

/// Expands `#include "..."` recursively: paths are taken relative to the including file, then to
/// the roots (renderer/ and the directory of Random123). Files with `#pragma once` are expanded
/// once; each piece is preceded by `#line` with its own path, so that the compiler's messages name
/// the real file. `#include <...>` is left alone. An include that cannot be resolved becomes an
/// `#error` naming file and line, which ends the build unless it stands in a branch that is not
/// compiled. Throws `Error` (run failed) when `path` itself does not exist.
std::string expand_source(const std::string &path, const SourceOverlays &overlays = {});

/// "FILE:LINE" of a line, counted from 1, of what `expand_source` returned; "defines:LINE" before
/// its first `#line`.
std::string source_place(const std::string &expanded, size_t line);

}  // namespace rtrays
