// SPDX-License-Identifier: MIT
// Reads the textures of materials.
#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/bsdf.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/graph.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Returns uv_scale, uv_offset and the file's own filter settings of a texture whose image has its
/// first row at the top.
ParameterValues read_placement(Object &object, UvConvention uv) {
    Eigen::Matrix4d to_uv = object.transform("to_uv");
    if (object.element().is_old()) {
        // Mitsuba 3 converts these properties so, offset before scale.
        const Vector3d scale(object.number("uscale", 1), object.number("vscale", 1), 1);
        const Vector3d offset(object.number("uoffset", 0), object.number("voffset", 0), 0);
        to_uv = scaling(scale) * translation(offset) * to_uv;
    }
    if (to_uv(0, 1) != 0 || to_uv(1, 0) != 0) {
        throw object.property("to_uv").error(
            "textures can only be scaled and translated; remove the rotation");
    }
    const Vector2d scale(to_uv(0, 0), to_uv(1, 1));
    // Mitsuba looks up row scale v + offset from the top. Let v' be our coordinate. If v = v', the
    // row from the bottom is 1 - scale v' - offset. If v = 1 - v', it is
    // scale v' + 1 - scale - offset.
    const bool flipped = uv == UvConvention::flipped;
    return {{"uv_scale", Vector2d(scale[0], flipped ? scale[1] : -scale[1])},
            // The fourth column of the matrix translates.
            {"uv_offset",
             Vector2d(to_uv(0, 3), flipped ? 1 - scale[1] - to_uv(1, 3) : 1 - to_uv(1, 3))}};
}

}  // namespace

std::shared_ptr<Texture> MaterialReader::texture(const Element &element, UvConvention uv,
                                                 TextureUse use) {
    const bool is_attribute = element.attribute("type") == "mesh_attribute";
    if (uv == UvConvention::none && !is_attribute) {
        throw element.error(
            "this shape has no texture coordinates that match Mitsuba's; use one colour, or a mesh "
            "with texture coordinates");
    }
    std::shared_ptr<Texture> &texture =
        textures_[{element.hash(), is_attribute ? UvConvention::none : uv, use}];
    if (texture != nullptr) {
        return texture;
    }
    Object object(element, document_);
    const bool is_bitmap = object.type() == "bitmap";
    if (!is_bitmap && !is_attribute && object.type() != "checkerboard") {
        throw element.error(
            "unsupported texture type; supported types are: bitmap, checkerboard, mesh_attribute");
    }
    texture = element.located([&] {
        return is_bitmap      ? bitmap(object, uv)
               : is_attribute ? mesh_attribute(object)
                              : checkerboard(object, uv, use);
    });
    if (element.has("id")) {
        scene_.graph().share("textures." + texture->name(), texture);
    }
    return texture;
}

std::shared_ptr<Texture> MaterialReader::bitmap(Object &object, UvConvention uv) {
    const Element &element = object.element();
    const std::optional<std::string> file = object.text("filename");
    if (!file.has_value()) {
        throw element.error("needs a filename");
    }
    const std::vector<std::string> filters = {"bilinear", "nearest"};
    ParameterValues values = read_placement(object, uv);
    values["filter"] = filters[object.choice("filter_type", filters, 0)];
    values["wrap"] = wrap_names()[object.choice("wrap_mode", wrap_names(), 0)];
    const bool raw = object.boolean("raw", false);
    object.ignore("format");  // of texels in Mitsuba's memory
    object.ignore("accel");
    object.finish();

    const std::filesystem::path path = element.path(*file);
    const auto image = files_.load(
        path, raw || holds_floats(path) ? TextureEncoding::linear : TextureEncoding::srgb);
    const std::string wanted = element.has("id") ? object.id() : path.stem().string();
    return std::make_shared<Texture>(texture_names_.unique(wanted), image, values);
}

/// Returns an image of 2 x 2 texels without interpolation, which is the same pattern. As a number,
/// Mitsuba 3.9 exchanges the two colours (Checkerboard::eval_1).
std::shared_ptr<Texture> MaterialReader::checkerboard(Object &object, UvConvention uv,
                                                      TextureUse use) {
    Vector3d colours[] = {object.colour("color0").value_or(Vector3d::Constant(0.4)),
                          object.colour("color1").value_or(Vector3d::Constant(0.2))};
    if (use == TextureUse::number) {
        std::swap(colours[0], colours[1]);
        notice(
            object.element()
                .error("color0 and color1 are exchanged, as Mitsuba does where it needs a number "
                       "instead of a colour")
                .what());
    }
    ParameterValues values = read_placement(object, uv);
    values["filter"] = std::string("nearest");
    values["wrap"] = std::string("repeat");
    object.finish();
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 2;
    for (const size_t texel : {0, 1, 1, 0}) {
        for (const double channel : colours[texel]) {
            image->floats.push_back(static_cast<float>(channel));
        }
    }
    const Element &element = object.element();
    const std::string wanted = element.has("id") ? object.id() : "checkerboard";
    return std::make_shared<Texture>(texture_names_.unique(wanted), image, values);
}

/// Returns the colours of vertices, whose factor is an image of one texel.
std::shared_ptr<Texture> MaterialReader::mesh_attribute(Object &object) {
    const Element &element = object.element();
    const std::string name = object.text("name", "");
    if (name != "vertex_color") {
        throw element.error(fmt::format(
            "unsupported attribute '{}'; the supported one is vertex_color, the red, green and "
            "blue of the vertices of a PLY file",
            name));
    }
    const double scale = object.number("scale", 1);
    object.finish();
    if (!(scale >= 0)) {
        throw element.error(fmt::format("scale: {} is negative", scale));
    }
    auto image = std::make_shared<TextureImage>(*white_image());
    if (scale != 1) {
        image->bytes.clear();
        image->floats.assign(3, static_cast<float>(scale));
    }
    const std::string wanted = element.has("id") ? object.id() : "vertex_color";
    return std::make_shared<Texture>(
        texture_names_.unique(wanted), image,
        ParameterValues{{"filter", std::string("nearest")}, {"vertex_colours", true}});
}

}  // namespace rtrays::mitsuba
