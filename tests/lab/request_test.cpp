// The one declaration of a request's values, over all of them: what they change, and where they come back.
#include "lab/request/request.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "hwsim/config/assign.h"
#include "lab/request/run_file.h"
#include "lab/results/run_files.h"
#include "lab/store/trace_store.h"
#include "pipeline/image/image_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Gives the value another one, inside its range and among its words.
void change(const Field& field) {
  if (auto* const* number = std::get_if<double*>(&field.slot))
    **number = **number == 0.0 ? 0.5 : **number * 0.5;
  else if (auto* const* whole = std::get_if<int*>(&field.slot))
    **whole += 1;
  else if (auto* const* flag = std::get_if<bool*>(&field.slot))
    **flag = !**flag;
  else if (std::string& text = *std::get<std::string*>(field.slot); !field.info.choices.empty())
    text = field.info.choices.substr(field.info.choices.rfind('|') + 1);
  else if (field.info.key.name == "engine")
    text = "roofline";
  else if (field.info.key.name == "skip")
    text = "none";
  else
    text = "1";
}

using Json = nlohmann::ordered_json;

/// Every value of a request, with the part of the manifest that it stands in.
std::vector<std::pair<const char*, Field>> every_field(Request& request) {
  std::vector<std::pair<const char*, Field>> all;
  for (const Field& field : fields_of(request.view)) all.emplace_back("view", field);
  for (const Field& field : fields_of(request.settings)) all.emplace_back("settings", field);
  return all;
}

Json json_of(const Field& field) {
  Json json;
  std::visit([&](const auto& value) { json = value; }, value_in(field.slot));
  return json;
}

Names names_of(const std::vector<Field>& fields, bool (*wanted)(const FieldInfo&)) {
  Names names;
  for (const Field& field : fields)
    if (wanted(field.info)) names.emplace(field.info.key.name);
  return names;
}

/// The values of a view that, each changed alone, change its text for a cache's key.
Names changing(FieldUse use) {
  Names names;
  View plain;
  const std::size_t count = fields_of(plain).size();
  for (std::size_t i = 0; i < count; ++i) {
    View view;
    const Field field = fields_of(view)[i];
    change(field);
    if (key_text(view, use) != key_text(plain, use)) names.emplace(field.info.key.name);
  }
  return names;
}

// What a technique draws depends on all that the view says; the content of the scene and the index of the
// camera stand in the keys in place of their names. The reference alone knows two ways to its shadows.
TEST(Request, EveryValueOfAViewChangesTheKeysOfTheCaches) {
  View view;
  Names all = names_of(fields_of(view), [](const FieldInfo&) { return true; });
  for (const char* elsewhere : {"scene", "camera", "exposure", "memory_mib"}) all.erase(elsewhere);
  EXPECT_EQ(changing(kReference), all);
  all.erase("reference_shadows");
  EXPECT_EQ(changing(kWork), all);
}

TEST(Request, TheKeyOfATraceHoldsEveryValueOfItsView) {
  const std::string image = (fs::path(::testing::TempDir()) / "hwsim_request.png").string();
  pipeline::write_image(pipeline::Image(8, 8), image);
  const Cache cache{""};
  Observer silent;
  const algos::TechniqueChoice technique = algos::parse_technique("fxaa");
  const GpuConfig gpu;
  const auto work = [&](const View& view, const FrameNeeds& needs = {}) {
    return TraceStore::work_text(SceneView(view, cache, silent), technique, gpu, needs);
  };
  View plain;
  plain.scene = image;
  for (std::size_t i = 0; i < fields_of(plain).size(); ++i) {
    View view = plain;
    const Field field = fields_of(view)[i];
    if ((field.info.uses & kWork) == 0 || field.info.key.name.ends_with("_px"))
      continue;  // it has its own size
    change(field);
    EXPECT_NE(work(view), work(plain)) << field.info.key.name;
  }
  FrameNeeds unskipped;
  for (const pipeline::SkipInfo& info : pipeline::kSkips)
    unskipped.skip.*info.flag = !(unskipped.skip.*info.flag);
  EXPECT_NE(work(plain, unskipped), work(plain));
  fs::remove(image);
}

/// Two cameras that see the same triangle, `x` of whose corners is in the file.
std::string two_cameras(const std::string& name, const std::string& corner) {
  const std::string path = (fs::path(::testing::TempDir()) / name).string();
  std::ofstream(path) << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]}, {"camera": 1, "translation": [0, 0, 4]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
    "extensionsUsed": ["KHR_lights_punctual"], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [-2, -1, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                      << corner << R"(AAAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})";
  return path;
}

// The camera's index and the scene's content stand in the key by hand, as the user's names for them do not.
TEST(Request, TheKeyOfATraceHoldsTheCameraTheContentAndTheExposure) {
  const Cache cache{""};
  Observer silent;
  const algos::TechniqueChoice technique = algos::parse_technique("none");
  const auto work = [&](const View& view) {
    return TraceStore::work_text(SceneView(view, cache, silent), technique, GpuConfig(), {});
  };
  View plain;
  plain.scene = two_cameras("hwsim_cameras.gltf", "AACAvwAAgL8A");
  View other_camera = plain, other_content = plain, other_exposure = plain;
  other_camera.camera = "1";
  other_content.scene = two_cameras("hwsim_cameras_2.gltf", "AAAAwAAAgL8A");
  other_exposure.exposure = 0.25;
  for (const View& other : {other_camera, other_content, other_exposure}) EXPECT_NE(work(other), work(plain));
  View same = plain;
  same.scene = two_cameras("hwsim_cameras_3.gltf", "AACAvwAAgL8A");
  EXPECT_EQ(work(same), work(plain)) << "another name for the same scene";
  for (const View& view : {plain, other_content, same}) fs::remove(view.scene);
}

TEST(Request, FrameHasTheDefaultsOfAView) {
  const View view;
  const algos::FrameRequest frame;
  EXPECT_EQ(frame.point_lights, view.point_lights);
  EXPECT_EQ(frame.light_range, view.light_range);
  EXPECT_EQ(frame.light_strength, view.light_strength);
  EXPECT_EQ(frame.shadows, view.shadows);
  EXPECT_EQ(frame.shadow_map_px, view.shadow_map_px);
  EXPECT_EQ(frame.metal_ambient, view.metal_ambient);
}

TEST(Request, MistypedKeyOfAGeneratedSceneFindsTheViewsKeys) {
  Request request;
  request.view.scene = "grass:seed=3";
  std::vector<Diagnostic> problems;
  apply(request, {parse_assignment("scene.point_light=2"), parse_assignment("scene.shadow=false")}, problems);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].hint.find("point_lights"), std::string::npos) << problems[0].hint;
  EXPECT_NE(problems[1].hint.find("shadows"), std::string::npos) << problems[1].hint;
  EXPECT_EQ(request.view.scene, "grass:seed=3");
}

/// The request that comes back from a run.toml which one changed value was written to.
class RunFile : public ::testing::Test {
 protected:
  Request there_and_back(const Request& request) {
    const RunPlan plan = make_plan(request, files_);
    const std::string path = (fs::path(::testing::TempDir()) / "hwsim_request_run.toml").string();
    std::ofstream(path) << run_file_text(plan, plan.techniques.front(), "gtx980");
    const Request back = read_run_file(path);
    fs::remove(path);
    return back;
  }
  static Request request() {
    Request r;
    r.view.scene = "sponza_hall";
    return r;
  }
  ConfigFiles files_;
};

TEST_F(RunFile, EveryValueReadsBack) {
  Request plain = request();
  const std::size_t count = every_field(plain).size();
  for (std::size_t i = 0; i < count; ++i) {
    Request changed = request();
    const Field field = every_field(changed)[i].second;
    if (field.info.file_key.empty()) continue;  // what is written beside the numbers is asked for each time
    change(field);
    const Request back = there_and_back(changed);
    EXPECT_EQ(back.view, changed.view) << field.info.key.name;
    EXPECT_EQ(back.settings, changed.settings) << field.info.key.name;
  }
}

// No field is named here: whoever declares one has it in all of these places, or fails.
class OneDeclaration : public RunFile {
 protected:
  /// Calls `check` with each field, changed alone in its request.
  template <class Check>
  void for_each_changed(const Check& check) {
    Request plain = request();
    const std::size_t count = every_field(plain).size();
    EXPECT_GT(count, 10u);
    for (std::size_t i = 0; i < count; ++i) {
      Request changed = request();
      const auto [part, field] = every_field(changed)[i];
      SCOPED_TRACE(std::string(field.info.key.name));
      EXPECT_EQ(json_of(field), json_of(every_field(plain)[i].second));
      change(field);
      EXPECT_NE(json_of(field), json_of(every_field(plain)[i].second));
      check(part, field, changed);
    }
  }
};

TEST_F(OneDeclaration, TheManifestRecordsEveryValue) {
  for_each_changed([&](const char* part, const Field& field, const Request& changed) {
    const RunPlan plan = make_plan(changed, files_);
    const Json recorded = manifest({.arguments = {}, .plan = &plan, .state = "done"}).at("request");
    EXPECT_EQ(recorded.at(part).at(std::string(field.info.key.name)), json_of(field));
  });
}

TEST_F(OneDeclaration, TheManifestsSchemaDescribesEveryValue) {
  const Json schema = Json::parse(manifest_schema_json()).at("properties").at("request").at("properties");
  std::size_t described = 0;
  for_each_changed([&](const char* part, const Field& field, const Request&) {
    const Json& property = schema.at(part).at("properties").at(std::string(field.info.key.name));
    ++described;
    EXPECT_EQ(property.at("description").get<std::string>(), field.info.key.description);
    const Json value = json_of(field);
    EXPECT_EQ(property.at("type"), value.is_boolean()          ? "boolean"
                                   : value.is_string()         ? "string"
                                   : value.is_number_integer() ? "integer"
                                                               : "number");
    if (value.is_number()) {
      EXPECT_GE(value.get<double>(), property.at("minimum").get<double>());
      EXPECT_LE(value.get<double>(), property.at("maximum").get<double>());
    }
    EXPECT_EQ(property.contains("enum"), !field.info.choices.empty());
  });
  EXPECT_EQ(schema.at("view").at("properties").size() + schema.at("settings").at("properties").size(),
            described)
      << "the schema describes what no request has";
}

TEST_F(OneDeclaration, RunFilesHoldTheValuesThatHaveAKeyThereAndTheirSchemaTheSame) {
  const Json schema = Json::parse(run_schema_json()).at("properties");
  for_each_changed([&](const char*, const Field& field, const Request& changed) {
    const Request back = there_and_back(changed);
    if (field.info.file_key.empty()) {
      EXPECT_FALSE(schema.contains(std::string(field.info.key.name)));
      return;
    }
    EXPECT_EQ(back.view, changed.view);
    EXPECT_EQ(back.settings, changed.settings);
    EXPECT_EQ(schema.at(std::string(field.info.file_key)).at("description").get<std::string>(),
              field.info.key.description);
  });
}

TEST_F(OneDeclaration, SetReachesTheValuesThatHaveAGroup) {
  for_each_changed([&](const char*, const Field& field, Request& changed) {
    if (field.info.group.empty()) return;
    const Json wanted = json_of(field);
    Request set = request();
    std::vector<Diagnostic> problems;
    const std::string path = std::string(field.info.group) + "." + std::string(field.info.key.name);
    apply(set, {{path, wanted.is_string() ? wanted.get<std::string>() : wanted.dump()}}, problems);
    EXPECT_TRUE(problems.empty()) << problems.front().message;
    EXPECT_EQ(set.view, changed.view);
    EXPECT_EQ(set.settings, changed.settings);
  });
}

TEST_F(OneDeclaration, CachesKeysChangeWithTheValuesThatSaySo) {
  const Request plain = request();
  for_each_changed([&](const char*, const Field& field, const Request& changed) {
    for (const FieldUse use : {kWork, kReference})
      EXPECT_EQ(key_text(changed.view, use) + key_text(changed.settings, use) !=
                    key_text(plain.view, use) + key_text(plain.settings, use),
                (field.info.uses & use) != 0)
          << use;
  });
}

TEST_F(RunFile, SchemaNamesEveryKeyThatIsWritten) {
  const auto schema = nlohmann::json::parse(run_schema_json());
  Names known, written;
  for (const auto& [name, value] : schema.at("properties").items()) known.insert(name);
  const RunPlan plan = make_plan(request(), files_);
  std::istringstream text(run_file_text(plan, plan.techniques.front(), "gtx980"));
  for (std::string line; std::getline(text, line);) written.insert(line.substr(0, line.find(' ')));
  EXPECT_EQ(known, written);
  EXPECT_EQ(schema.at("properties").at("width_px").at("maximum"), kMaxSidePx);
  EXPECT_EQ(schema.at("properties").at("lights").at("enum"),
            (nlohmann::json{"scene", "simple", "complex", "added"}));
}

}  // namespace
}  // namespace hwsim::lab
