// SPDX-License-Identifier: MIT
#include "renderer/import/models/mtl.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/lower_case.h"
#include "renderer/import/models/statements.h"

namespace rtrays {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A statement that has no counterpart here, in lower case, with the note about it.
struct Ignored {
    std::string_view keyword;
    const char *note;
};
constexpr Ignored ignored[] = {
    {"map_ka", "ambient and occlusion maps are ignored"},
    {"map_tr", "maps of Tr are ignored; give the opacity as map_d"},
    {"map_ns", "shininess maps are ignored"},
    {"disp", "displacement maps are ignored"},
    {"map_disp", "displacement maps are ignored"},
    {"refl", "reflection maps are ignored"},
    {"map_refl", "reflection maps are ignored"},
    {"map_pr", "metalness and roughness maps of MTL are ignored"},
    {"map_pm", "metalness and roughness maps of MTL are ignored"},
    {"ps", "sheen and clear coats are ignored"},
    {"map_ps", "sheen and clear coats are ignored"},
    {"pc", "sheen and clear coats are ignored"},
    {"pcr", "sheen and clear coats are ignored"},
};

/// What the statements of one material say, before they are combined.
struct Stated {
    MtlMaterial material;
    size_t line = 0;
    int illumination = 1;
    std::optional<double> d;
    std::optional<double> transparency;  ///< Tr
    std::optional<double> roughness;     ///< Pr
    std::optional<double> metalness;     ///< Pm
};

class MtlReader {
  public:
    MtlReader(std::string_view text, std::filesystem::path folder, ModelNotes &notes)
        : reader_(text), folder_(std::move(folder)), notes_(notes) {}

    std::vector<MtlMaterial> read() {
        Statement statement;
        while (reader_.next(statement)) {
            line_ = statement.line;
            if (in_lower_case(statement.keyword) == "newmtl") {
                finish();
                current_.emplace();
                current_->material.name = name_of(statement.rest);
                current_->material.folder = folder_;
                current_->line = line_;
            } else if (current_) {
                read(statement);
            } else {
                throw input_error(
                    fmt::format("'{}' before the first newmtl", shown(statement.keyword)));
            }
        }
        finish();
        return std::move(made_);
    }

    size_t line() const { return line_; }

  private:
    void read(const Statement &statement) {
        const std::string keyword = in_lower_case(statement.keyword);
        const std::string_view rest = without_comment(statement.rest);
        ModelSurface &surface = current_->material.surface;
        if (keyword == "kd") {
            surface.diffuse = colour(rest);
        } else if (keyword == "ks") {
            surface.specular = colour(rest);
        } else if (keyword == "ke") {
            surface.emission = colour(rest);
        } else if (keyword == "tf") {
            surface.transmittance = colour(rest);
        } else if (keyword == "ns") {
            surface.exponent = number(rest);
        } else if (keyword == "ni") {
            surface.eta = number(rest);
        } else if (keyword == "d") {
            current_->d = opacity(rest);
        } else if (keyword == "tr") {
            current_->transparency = number(rest);
        } else if (keyword == "pr") {
            current_->roughness = number(rest);
        } else if (keyword == "pm") {
            current_->metalness = number(rest);
        } else if (keyword == "illum") {
            current_->illumination = illumination(rest);
        } else if (keyword == "map_kd") {
            current_->material.diffuse_map = map(statement);
        } else if (keyword == "map_ks") {
            current_->material.specular_map = map(statement);
        } else if (keyword == "map_d") {
            current_->material.opacity_map = map(statement);
        } else if (keyword == "map_ke") {
            current_->material.emission_map = map(statement);
        } else if (keyword == "norm" || keyword == "map_kn") {
            current_->material.normal_map = map(statement);
        } else if (keyword == "map_bump" || keyword == "bump") {
            current_->material.bump_map = map(statement);
        } else if (keyword == "ka") {
            if (!colour(rest).isZero()) {
                notes_.add("ambient colours are ignored", current_->material.name);
            }
        } else {
            ignore(keyword);
        }
    }

    static int illumination(std::string_view rest) {
        const double value = number(rest);
        if (!(value >= 0 && value <= 10) || value != std::floor(value)) {
            throw input_error(fmt::format("illum: {} is not one of 0 to 10", value));
        }
        return static_cast<int>(value);
    }

    void ignore(std::string_view keyword) {
        for (const Ignored &row : ignored) {
            if (keyword == row.keyword) {
                notes_.add(row.note, current_->material.name);
                return;
            }
        }
        notes_.add("statements that are unsupported here are ignored",
                   fmt::format("'{}' in line {}", shown(keyword), line_));
    }

    static double number(std::string_view rest) {
        double value = 0;
        const std::string_view word = take_word(rest);
        if (!parse_number(word, value) || !std::isfinite(value)) {
            throw input_error(fmt::format("expected a number, got '{}'", shown(word)));
        }
        if (!take_word(rest).empty()) {
            throw input_error("expected one number, got more");
        }
        return value;
    }

    double opacity(std::string_view rest) {
        std::string_view after = rest;
        if (take_word(after) == "-halo") {
            notes_.add("'d -halo' is read as 'd'", current_->material.name);
            return number(after);
        }
        return number(rest);
    }

    /// Reads three numbers, or one for all channels.
    static Vector3d colour(std::string_view rest) {
        std::string_view after = rest;
        const std::string_view kind = take_word(after);
        if (kind == "spectral" || kind == "xyz") {
            throw input_error(fmt::format(
                "colours of kind '{}' are unsupported; give red, green and blue", kind));
        }
        Vector3d value = Vector3d::Zero();
        int count = 0;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            if (count == 3 || !parse_number(word, value[count]) || !std::isfinite(value[count])) {
                throw input_error(
                    fmt::format("expected one number or three, got '{}'", shown(word)));
            }
            ++count;
        }
        if (count != 1 && count != 3) {
            throw input_error(fmt::format("expected one number or three, got {}", count));
        }
        return count == 1 ? Vector3d::Constant(value[0]) : value;
    }

    /// Reads up to `most` numbers that follow an option. Absent ones keep their values.
    static void option_numbers(std::string_view &rest, double *values, int most) {
        for (int i = 0; i < most; ++i) {
            std::string_view after = rest;
            const std::string_view word = take_word(after);
            double value = 0;
            if (!parse_number(word, value)) {
                return;
            }
            values[i] = value;
            rest = after;
        }
    }

    /// Reads the options and the file of a map.
    MtlMap map(const Statement &statement) {
        MtlMap made;
        std::string_view rest = trimmed(statement.rest);
        while (!rest.empty() && rest.front() == '-') {
            std::string_view after = rest;
            const std::string_view option = take_word(after);
            double values[3] = {};
            if (option == "-s" || option == "-o") {
                Vector2d &pair = option == "-s" ? made.placement.scale : made.placement.offset;
                values[0] = pair[0];
                values[1] = pair[1];
                option_numbers(after, values, 3);
                pair = {values[0], values[1]};
            } else if (option == "-clamp") {
                made.placement.wrap = take_word(after) == "on" ? TextureArrays::Wrap::clamp
                                                               : TextureArrays::Wrap::repeat;
            } else if (option == "-bm") {
                option_numbers(after, &made.multiplier, 1);
            } else if (option == "-t") {
                option_numbers(after, values, 3);
                note_option(option, statement);
            } else if (option == "-mm") {
                option_numbers(after, values, 2);
                note_option(option, statement);
            } else if (option == "-blendu" || option == "-blendv" || option == "-cc" ||
                       option == "-boost" || option == "-texres" || option == "-imfchan" ||
                       option == "-type") {
                take_word(after);
                note_option(option, statement);
            } else {
                throw input_error(
                    fmt::format("unknown option '{}' of {}", shown(option), statement.keyword));
            }
            rest = trimmed(after);
        }
        made.file = name_of(rest);
        if (made.file.size() > 1 && made.file.front() == '"' && made.file.back() == '"') {
            made.file = made.file.substr(1, made.file.size() - 2);
        }
        if (made.file.empty()) {
            throw input_error(fmt::format("{} names no file", statement.keyword));
        }
        return made;
    }

    void note_option(std::string_view option, const Statement &statement) {
        notes_.add("options of maps that are unsupported here are ignored",
                   fmt::format("'{}' in line {}", option, statement.line));
    }

    /// Combines the statements of the current material.
    void finish() {
        if (!current_) {
            return;
        }
        Stated &stated = *current_;
        ModelSurface &surface = stated.material.surface;
        const std::string &name = stated.material.name;
        set_opacity(stated);
        const int illumination = stated.illumination;
        surface.refracts =
            illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9;
        surface.only_reflects =
            (illumination == 3 || illumination == 5) && surface.diffuse.isZero();
        surface.alpha = std::sqrt(2 / (std::max(surface.exponent, 0.0) + 2));
        if (stated.roughness && stated.metalness) {
            surface.is_physical = true;
            surface.only_reflects = false;
            surface.metalness = *stated.metalness;
            surface.alpha = *stated.roughness * *stated.roughness;
            if (!(surface.eta > 1)) {
                surface.eta = ModelSurface::glass_eta;
            }
        } else if (stated.roughness || stated.metalness) {
            notes_.add("Pr without Pm and Pm without Pr are ignored", name);
        }
        note_black_maps(stated.material);
        made_.push_back(std::move(stated.material));
        current_.reset();
    }

    void note_black_maps(const MtlMaterial &material) {
        const ModelSurface &surface = material.surface;
        if (!material.diffuse_map.file.empty() && surface.diffuse.isZero()) {
            notes_.add("map_Kd has no effect, because it is multiplied by 'Kd 0 0 0'",
                       material.name);
        }
        if (!material.emission_map.file.empty() && surface.emission.isZero()) {
            notes_.add("map_Ke has no effect, because it is multiplied by Ke, which is 0",
                       material.name);
        }
    }

    void set_opacity(const Stated &stated) {
        ModelSurface &surface = current_->material.surface;
        const std::string &name = stated.material.name;
        if (stated.d) {
            surface.opacity = *stated.d;
        } else if (stated.transparency) {
            surface.opacity = 1 - *stated.transparency;
        }
        if (stated.d && stated.transparency && *stated.d != 1 - *stated.transparency) {
            notes_.add("'Tr' is ignored where it contradicts 'd'", name);
        }
        if (surface.opacity <= 0) {
            notes_.add(
                "materials are invisible; where 'Tr 1' or 'd 0' means opaque, set 'd 1' in the MTL "
                "file",
                name);
        }
    }

    StatementReader reader_;
    std::filesystem::path folder_;
    ModelNotes &notes_;
    size_t line_ = 0;
    std::optional<Stated> current_;
    std::vector<MtlMaterial> made_;
};

/// Returns the texture of the opacity, or nullptr: map_d, or else the alpha channel of map_Kd. The
/// alpha channel of map_d counts if there is one, and otherwise its colours.
std::shared_ptr<Texture> opacity_texture(const MtlMaterial &material, const std::string &name,
                                         const std::vector<std::filesystem::path> &folders,
                                         ModelTextures &textures, ModelNotes &notes) {
    const bool is_stated = !material.opacity_map.file.empty();
    const MtlMap &map = is_stated ? material.opacity_map : material.diffuse_map;
    if (map.file.empty()) {
        return nullptr;
    }
    std::shared_ptr<const TextureImage> image = textures.load_alpha(map.file, folders);
    if (image == nullptr && is_stated) {
        image = textures.load(map.file, folders, false);
    } else if (image != nullptr && !is_stated) {
        notes.add("the alpha channel of map_Kd is the opacity", name);
    }
    return image != nullptr ? textures.texture(image, map.file + "_alpha", map.placement) : nullptr;
}

/// Returns whether all texels are grey.
bool is_grey(const TextureImage &image) {
    const auto equal = [](const auto &values) {
        for (size_t i = 0; i + 2 < values.size(); i += 3) {
            if (values[i] != values[i + 1] || values[i] != values[i + 2]) {
                return false;
            }
        }
        return true;
    };
    return equal(image.bytes) && equal(image.floats);
}

/// Sets the map of normals or of heights. Many programs write a map of normals as map_Bump; its
/// colours tell.
void set_normals(const MtlMaterial &material, const std::string &name,
                 const std::vector<std::filesystem::path> &folders, ModelTextures &textures,
                 ModelNotes &notes, ModelSurface &surface) {
    const bool has_normals = !material.normal_map.file.empty();
    const MtlMap &map = has_normals ? material.normal_map : material.bump_map;
    if (map.file.empty()) {
        return;
    }
    if (has_normals && !material.bump_map.file.empty()) {
        notes.add("map_Bump is ignored beside a map of normals", name);
    }
    const std::shared_ptr<const TextureImage> image = textures.load(map.file, folders, false);
    const auto texture = textures.texture(image, map.file, map.placement);
    surface.map_scale = map.multiplier;
    if (has_normals || !is_grey(*image)) {
        surface.normal_texture = texture;
        if (!has_normals) {
            notes.add("coloured images of map_Bump are maps of normals", name);
        }
    } else {
        surface.bump_texture = texture;
        notes.add("heights of map_Bump are in units of the model", name);
    }
}

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::filesystem::path &path, ModelNotes &notes) {
    if (!is_file(path)) {
        throw input_error(fmt::format("{}: no such file", path.string()));
    }
    const std::string text = read_file(path);
    MtlReader reader(text, path.parent_path(), notes);
    try {
        return reader.read();
    } catch (const Error &error) {
        throw Error(error.exit_code(),
                    fmt::format("{}:{}: {}", path.string(), reader.line(), error.what()));
    }
}

std::shared_ptr<MaterialCore> make_mtl_material(const MtlMaterial &material,
                                                const std::string &name,
                                                const std::filesystem::path &model_folder,
                                                bool vertex_coloured, ModelTextures &textures,
                                                ModelNotes &notes) {
    const std::vector<std::filesystem::path> folders = {material.folder, model_folder};
    ModelSurface surface = material.surface;
    try {
        const auto texture = [&](const MtlMap &map) {
            return map.file.empty() ? nullptr
                                    : textures.texture(textures.load(map.file, folders, true),
                                                       map.file, map.placement);
        };
        MtlMap diffuse_map = material.diffuse_map;
        diffuse_map.placement.vertex_colours = vertex_coloured;
        surface.diffuse_texture = vertex_coloured && diffuse_map.file.empty()
                                      ? textures.vertex_colours()
                                      : texture(diffuse_map);
        surface.specular_texture = surface.is_physical ? nullptr : texture(material.specular_map);
        surface.opacity_texture = opacity_texture(material, name, folders, textures, notes);
        set_normals(material, name, folders, textures, notes, surface);
        if (!surface.emission.isZero()) {
            surface.emission_texture = texture(material.emission_map);
        }
        return make_model_material(surface, name, notes);
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("material '{}': {}", name, error.what()));
    }
}

}  // namespace rtrays
