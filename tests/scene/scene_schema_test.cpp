// Every scene file must satisfy the schema: checked by the few keywords of draft 7 that the schema uses.
#include "scene/scene_schema.h"

#include "core/json_text.h"
#include "fixtures.h"
#include "scene/generators.h"

namespace penumbra::test {
namespace {

using nlohmann::json;

bool satisfies(const json& value, const json& schema);

bool type_fits(const json& v, const std::string& type) {
  if (type == "object") return v.is_object();
  if (type == "array") return v.is_array();
  if (type == "string") return v.is_string();
  if (type == "boolean") return v.is_boolean();
  if (type == "integer") return v.is_number_integer();
  return v.is_number();
}

bool object_fits(const json& v, const json& schema) {
  for (const json& key : schema.value("required", json::array()))
    if (!v.contains(key.get<std::string>())) return false;
  const json properties = schema.value("properties", json::object());
  for (const auto& [key, member] : v.items()) {
    if (properties.contains(key)) {
      if (!satisfies(member, properties[key])) return false;
    } else if (schema.contains("additionalProperties")) {
      const json& rest = schema["additionalProperties"];
      if (rest.is_boolean() ? !rest.get<bool>() : !satisfies(member, rest)) return false;
    }
  }
  return true;
}

bool array_fits(const json& v, const json& schema) {
  if (v.size() < schema.value("minItems", std::size_t{0}) || v.size() > schema.value("maxItems", v.size()))
    return false;
  for (const json& item : v)
    if (schema.contains("items") && !satisfies(item, schema["items"])) return false;
  return true;
}

bool satisfies(const json& v, const json& schema) {
  if (schema.contains("const") && v != schema["const"]) return false;
  if (schema.contains("type") && !type_fits(v, schema["type"])) return false;
  if (schema.contains("enum") &&
      std::find(schema["enum"].begin(), schema["enum"].end(), v) == schema["enum"].end())
    return false;
  if (schema.contains("minimum") && v < schema["minimum"]) return false;
  if (schema.contains("maximum") && v > schema["maximum"]) return false;
  if (schema.contains("exclusiveMinimum") && v <= schema["exclusiveMinimum"]) return false;
  if (schema.contains("anyOf")) {
    bool any = false;
    for (const json& option : schema["anyOf"]) any = any || satisfies(v, option);
    if (!any) return false;
  }
  return (!v.is_object() || object_fits(v, schema)) && (!v.is_array() || array_fits(v, schema));
}

TEST(SceneSchema, EverySceneOfTheRepositorySatisfiesIt) {
  const json schema = scene_schema();
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator("configs/scenes")) {
    if (entry.path().extension() != ".json") continue;
    ++scenes;
    EXPECT_TRUE(satisfies(JsonDocument::read(entry.path()).json(), schema)) << entry.path();
  }
  EXPECT_GE(scenes, 15);
}

TEST(SceneSchema, WhatTheParserRefusesItRefuses) {
  const json schema = scene_schema();
  json scene = json::parse(scene_text(R"("box": {"generator": "box"})", R"({"mesh": "box"})"));
  EXPECT_TRUE(satisfies(scene, schema));
  json bad = scene;
  bad["instance"] = 1;
  EXPECT_FALSE(satisfies(bad, schema));
  bad = scene, bad["meshes"]["box"]["params"]["size_w"] = 1;
  EXPECT_FALSE(satisfies(bad, schema));
  bad = scene, bad["lights"][0]["kind"] = "rectangel";
  EXPECT_FALSE(satisfies(bad, schema));
  bad = scene, bad["cameras"][0]["vertical_fov_degrees"] = 180;
  EXPECT_FALSE(satisfies(bad, schema));
}

}  // namespace
}  // namespace penumbra::test
