// SPDX-License-Identifier: MIT
// Tests the reduction of spectra to three channels. Expected values are those of Mitsuba 3.9,
// variant scalar_rgb.
#include "renderer/import/mitsuba/spectrum.h"

#include <cmath>

#include "renderer/testing/mitsuba_scenes.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using mitsuba::Spectrum;
using mitsuba::spectrum_colour;
using mitsuba::SpectrumUse;

void expect_near(const Vector3d &a, const Vector3d &b, double tolerance) {
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << a.transpose() << "\n" << b.transpose();
}

Vector3d reflectance(const std::string &spectrum) {
    return parse_elements("<shape type=\"cube\"><bsdf type=\"diffuse\">" + spectrum +
                          "</bsdf></shape>")
        .materials()
        .component[0]
        .weight.cast<double>();
}

Vector3d radiance(const std::string &spectrum) {
    return parse_elements("<shape type=\"cube\"><emitter type=\"area\">" + spectrum +
                          "</emitter></shape>")
        .lights()
        .radiance[0]
        .cast<double>();
}

TEST(MitsubaSpectra, WhiteIsWhite) {
    // Normalisations of the observer and of D65: a reflectance of 1 is white, and an emission of 1
    // is illuminant E.
    const Spectrum constant{{300, 900}, {1, 1}};
    expect_near(spectrum_colour(constant, SpectrumUse::index), Vector3d::Ones(), 2e-3);
    expect_near(spectrum_colour(constant, SpectrumUse::emission), mitsuba::illuminant_e(), 2e-3);
    expect_near(spectrum_colour({{300, 900}, {3, 3}}, SpectrumUse::reflectance), Vector3d::Ones(),
                1e-15);
}

TEST(MitsubaSpectra, AreReducedAsInMitsuba) {
    expect_near(reflectance(R"(<spectrum name="reflectance" value="400:0.1, 700:0.9"/>)"),
                {0.7428528070449829, 0.4811400771141052, 0.20832455158233643}, 1e-6);
    expect_near(reflectance(R"(<spectrum name="reflectance" value="400:0.5, 700:0.5"/>)"),
                {0.4976710081100464, 0.4998781979084015, 0.49745455384254456}, 1e-6);
    expect_near(radiance(R"(<spectrum name="radiance" value="400:0, 500:8, 600:15.6, 700:18.4"/>)"),
                {20.71083641052246, 10.854634284973145, 2.7711520195007324}, 1e-4);
    // Out of gamut: clipped to zero and, as a reflectance, to one.
    expect_near(reflectance(R"(<spectrum name="reflectance" value="500:0, 510:0.9, 520:0"/>)"),
                {0.0, 0.08615849167108536, 0.0062924460507929325}, 1e-6);
}

TEST(MitsubaSpectra, AreReadFromFiles) {
    const TemporaryFolder folder;
    folder.write("slope.spd", "# nm value\n400 0.1\n\n700 0.9\n");
    expect_near(reflectance("<spectrum name=\"reflectance\" filename=\"" +
                            (folder.path() / "slope.spd").string() + "\"/>"),
                reflectance(R"(<spectrum name="reflectance" value="400:0.1, 700:0.9"/>)"), 0);
}

TEST(MitsubaSpectra, HaveTypes) {
    expect_near(radiance(R"(<spectrum type="d65" name="radiance"/>)"), {1, 1, 1}, 0);
    expect_near(radiance(R"(<spectrum type="d65" name="radiance"><float name="scale" value="2"/>
        <rgb name="color" value="1, 2, 3"/></spectrum>)"),
                {2, 4, 6}, 0);
    expect_near(
        radiance(
            R"(<spectrum type="uniform" name="radiance"><float name="value" value="3"/></spectrum>)"),
        {3, 3, 3}, 0);
    expect_near(
        reflectance(
            R"(<spectrum type="srgb" name="reflectance"><rgb name="color" value="0.5, 0.25, 0"/></spectrum>)"),
        {0.5, 0.25, 0}, 0);
}

TEST(MitsubaSpectra, OfBlackBodies) {
    const auto body = [](int temperature) {
        return radiance(
            "<spectrum type=\"blackbody\" name=\"radiance\"><float name=\"temperature\" "
            "value=\"" +
            std::to_string(temperature) + "\"/></spectrum>");
    };
    // By Mitsuba's variant scalar_spectral, with 5e6 samples.
    const Vector3d mitsuba(15278.978, 12094.669, 9601.108);
    EXPECT_LT((body(5000) - mitsuba).norm(), 2e-3 * mitsuba.norm()) << body(5000).transpose();
    // The chromaticity of 6500 K on the Planckian locus (CIE 15), with the primaries of Rec. 709.
    const Vector3d rgb = body(6500);
    const double x = Vector3d(0.4124, 0.3576, 0.1805).dot(rgb);
    const double y = Vector3d(0.2126, 0.7152, 0.0722).dot(rgb);
    const double z = Vector3d(0.0193, 0.1192, 0.9505).dot(rgb);
    EXPECT_NEAR(x / (x + y + z), 0.3135, 5e-4);
    EXPECT_NEAR(y / (x + y + z), 0.3237, 5e-4);
}

TEST(MitsubaSpectra, GiveTheConstantsOfMetals) {
    const auto metal = [](const std::string &properties) {
        return parse_elements("<shape type=\"cube\"><bsdf type=\"conductor\">" + properties +
                              "</bsdf></shape>")
            .materials()
            .component[0];
    };
    struct Row {
        const char *name;
        Vector3d eta, k;
    };
    for (const Row &row : {Row{"Al",
                               {1.6575008630752563, 0.8804047107696533, 0.521244466304779},
                               {9.223811149597168, 6.26950216293335, 4.8370041847229}},
                           Row{"W",
                               {4.370816707611084, 3.300246477127075, 2.9984073638916016},
                               {3.500640630722046, 2.6048738956451416, 2.27323317527771}},
                           Row{"a-C",
                               {2.9440457820892334, 2.2271363735198975, 1.968161702156067},
                               {0.8874648809432983, 0.7992985248565674, 0.8152899742126465}}}) {
        const BxdfComponent part =
            metal("<string name=\"material\" value=\"" + std::string(row.name) + "\"/>");
        EXPECT_EQ(part.fresnel, BxdfComponent::Fresnel::conductor);
        expect_near(part.eta, row.eta, 1e-5);
        expect_near(part.k, row.k, 1e-5);
    }
    const BxdfComponent measured = metal(R"(<spectrum name="eta" value="400:1.2, 700:0.4"/>
        <spectrum name="k" value="400:2, 700:5"/>)");
    expect_near(measured.eta, {0.5510918498039246, 0.8185433149337769, 1.085057258605957}, 1e-5);
    expect_near(measured.k, {4.403128623962402, 3.428879499435425, 2.397944450378418}, 1e-5);
}

}  // namespace
}  // namespace rtrays
