// SPDX-License-Identifier: MIT
// Tests the strict JSON parser and the locations in its error messages.
#include "renderer/base/json.h"

#include <nlohmann/json.hpp>

#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

struct BadText {
    const char *text;
    const char *message;  ///< beginning of the error message
};

class StrictSyntax : public testing::TestWithParam<BadText> {};

TEST_P(StrictSyntax, NamesSourceLineAndPath) {
    const std::string message =
        error_of(ExitCode::bad_input, [] { parse_json(GetParam().text, "in.json"); });
    EXPECT_EQ(message.rfind(GetParam().message, 0), 0u) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Json, StrictSyntax,
    testing::Values(BadText{"", "in.json:1: syntax error"},
                    BadText{"{\n\"a\": 1,\n\"a\": 2}", "in.json:3: /a: duplicate key 'a'"},
                    BadText{"{\"x\": [{\"b\": 1, \"c\": 2,\n\n\"b\": 3}]}",
                            "in.json:3: /x/0/b: duplicate key 'b'"},
                    BadText{"{\"v\": [1,\n1e999]}", "in.json:2: /v/1: number overflow"},
                    BadText{"{\"name\": \"tile\", \"v\": [-1e999]}",
                            "in.json:1: /v/0 (in 'tile'): number overflow"},
                    BadText{"[1,\n2,\n]", "in.json:3: /2: syntax error"},
                    BadText{"{\"a\": NaN}", "in.json:1: /a: syntax error"},
                    BadText{"[1] 2", "in.json:1: syntax error"},
                    BadText{"{\"a\": // no\n1}", "in.json:1: /a: syntax error"},
                    BadText{"{\"a/b~\": nul}", "in.json:1: /a~1b~0: syntax error"},
                    BadText{"\"\xff\"", "in.json:1: syntax error"},
                    BadText{"{\"a\"", "in.json:1: /a: syntax error"}));

TEST(Json, ReadsWhatIsValid) {
    const Json value =
        parse_json(R"({"a": [1, -2, 0.5, true, null, "x\u00e9"], "b": {"a": {}}})", "in.json");
    EXPECT_EQ(value, Json::parse(R"({"a": [1, -2, 0.5, true, null, "xé"], "b": {"a": {}}})"));
}

TEST(Json, RefusesNestingThatCouldExhaustTheStack) {
    const auto nested = [](size_t depth) {
        return std::string(depth, '[') + std::string(depth, ']');
    };
    EXPECT_NO_THROW(parse_json(nested(max_json_depth), "in.json"));
    for (const size_t depth : {max_json_depth + 1, size_t{1000000}}) {
        expect_input_error("nested deeper than 256 levels",
                           [&] { parse_json(nested(depth), "in.json"); });
    }
}

TEST(Json, LocatesValuesByPointer) {
    const std::string text = "{\n\"a\": [\n 1,\n 2\n],\n\"b\": {\"c/d\": \"e\"}\n}\n";
    EXPECT_EQ(json_location("f", text, ""), "f:1");
    EXPECT_EQ(json_location("f", text, "/a"), "f:2: /a");
    EXPECT_EQ(json_location("f", text, "/a/0"), "f:3: /a/0");
    EXPECT_EQ(json_location("f", text, "/a/1"), "f:4: /a/1");  // the number ends with its line
    EXPECT_EQ(json_location("f", text, "/b/c~1d"), "f:6: /b/c~1d");
    EXPECT_EQ(json_location("f", text, "/none"), "f: /none");
    EXPECT_EQ(json_location("f", "", "/a"), "f: /a");
}

constexpr const char *schema = R"({
    "type": "object", "required": ["kind"], "additionalProperties": false,
    "properties": {
        "kind": {"type": "string", "enum": ["disc", "sphere"]},
        "radius": {"type": "number", "exclusiveMinimum": 0},
        "count": {"type": "integer", "minimum": 1, "maximum": 8},
        "parts": {"type": "array", "maxItems": 2, "items": {"$ref": "#"}},
        "paint": {"type": ["string", "object"], "if": {"type": "object"}, "then": {"$ref": "#/definitions/paint"}}
    },
    "definitions": {"paint": {"type": "object", "additionalProperties": false, "properties": {"hue": {"type": "number"}}}}
})";

class Schema : public testing::TestWithParam<BadText> {};

TEST_P(Schema, NamesPathFaultAndAlternatives) {
    const std::string text = GetParam().text;
    const Json document = parse_json(text, "in.json");
    const std::string message =
        error_of(ExitCode::bad_input, [&] { validate_json(document, schema, "in.json", text); });
    EXPECT_EQ(message.rfind(GetParam().message, 0), 0u) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Json, Schema,
    testing::Values(
        BadText{"{\n\"kind\": \"disk\"}", "in.json:2: /kind: \"disk\" is not one of: disc, sphere"},
        BadText{R"({"kind": "disc", "radios": 1})",
                "in.json:1: unknown key 'radios'; allowed: count, kind, paint, parts, radius"},
        BadText{"{}", "in.json:1: missing key 'kind'"},
        BadText{"[]", "in.json:1: [] is not of type object"},
        BadText{R"({"kind": "disc", "radius": 0})",
                "in.json:1: /radius: 0: Expected number greater than 0"},
        BadText{R"({"kind": "disc", "radius": "1"})",
                "in.json:1: /radius: \"1\" is not of type number"},
        BadText{R"({"kind": "disc", "count": 1.5})",
                "in.json:1: /count: 1.5 is not of type integer"},
        BadText{R"({"kind": "disc", "count": 9})",
                "in.json:1: /count: 9: Expected number less than or equal to 8"},
        BadText{R"({"kind": "disc", "count": null})",
                "in.json:1: /count: null is not of type integer"},
        BadText{"{\"kind\": \"disc\", \"parts\": [{\"kind\": \"disc\"},\n{\"kind\": \"disc\", "
                "\"x\": 1}]}",
                "in.json:2: /parts/1: unknown key 'x'; allowed: "},
        BadText{R"({"kind": "disc", "paint": {"hew": 1}})",
                "in.json:1: /paint: unknown key 'hew'; allowed: hue"},
        BadText{R"({"kind": "disc", "paint": 7})",
                "in.json:1: /paint: 7 is not of type string or object"}));

TEST(Json, AcceptsWhatTheSchemaAllows) {
    for (const char *text :
         {R"({"kind": "disc"})", R"({"kind": "sphere", "radius": 1e-300, "count": 8, "paint": "red",
                                 "parts": [{"kind": "disc", "paint": {"hue": 1}}]})"}) {
        EXPECT_NO_THROW(validate_json(parse_json(text, "in.json"), schema, "in.json"));
    }
}

}  // namespace
}  // namespace rtrays
