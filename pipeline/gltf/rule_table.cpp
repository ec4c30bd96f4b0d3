#include "pipeline/gltf/rule_table.h"

namespace hwsim::pipeline::gltf {
namespace {

constexpr bool kRequired = true, kOptional = false;

constexpr Rule kAnyExtension[] = {{"extensions", Kind::object_map}};

constexpr Rule kBuffer[] = {{"byteLength", Kind::count, kRequired},
                            {"uri", Kind::text},
                            {"name", Kind::text},
                            {"extensions", Kind::object_map}};
constexpr Rule kBufferView[] = {{"buffer", Kind::index, kRequired, "buffers"},
                                {"byteLength", Kind::count, kRequired},
                                {"byteOffset", Kind::count},
                                {"byteStride", Kind::count},
                                {"target", Kind::count},
                                {"name", Kind::text},
                                {"extensions", Kind::object_map}};

constexpr Rule kSparseIndices[] = {{"bufferView", Kind::index, kRequired, "bufferViews"},
                                   {"componentType", Kind::count, kRequired},
                                   {"byteOffset", Kind::count}};
constexpr Rule kSparseValues[] = {{"bufferView", Kind::index, kRequired, "bufferViews"},
                                  {"byteOffset", Kind::count}};
constexpr Rule kSparse[] = {{"count", Kind::count, kRequired},
                            {"indices", Kind::object, kRequired, "", 0, kSparseIndices},
                            {"values", Kind::object, kRequired, "", 0, kSparseValues}};
constexpr Rule kAccessor[] = {{"bufferView", Kind::index, kOptional, "bufferViews"},
                              {"byteOffset", Kind::count},
                              {"componentType", Kind::count, kRequired},
                              {"normalized", Kind::boolean},
                              {"count", Kind::count, kRequired},
                              {"type", Kind::text, kRequired},
                              {"min", Kind::numbers},
                              {"max", Kind::numbers},
                              {"name", Kind::text},
                              {"sparse", Kind::object, kOptional, "", 0, kSparse},
                              {"extensions", Kind::object_map}};

constexpr Rule kPrimitive[] = {
    {"attributes", Kind::index_map, kRequired, "accessors"}, {"indices", Kind::index, kOptional, "accessors"},
    {"material", Kind::index, kOptional, "materials"},       {"mode", Kind::count},
    {"targets", Kind::index_maps, kOptional, "accessors"},   {"extensions", Kind::object_map}};
constexpr Rule kMesh[] = {{"primitives", Kind::objects, kRequired, "", 0, kPrimitive},
                          {"weights", Kind::numbers},
                          {"name", Kind::text},
                          {"extensions", Kind::object_map}};

constexpr Rule kNodeLight[] = {{"light", Kind::index, kRequired, "lights"}};
constexpr Rule kNodeExtensions[] = {{"KHR_lights_punctual", Kind::object, kOptional, "", 0, kNodeLight}};
constexpr Rule kNode[] = {{"children", Kind::indices, kOptional, "nodes"},
                          {"mesh", Kind::index, kOptional, "meshes"},
                          {"camera", Kind::index, kOptional, "cameras"},
                          {"skin", Kind::index, kOptional, "skins"},
                          {"matrix", Kind::numbers, kOptional, "", 16},
                          {"translation", Kind::numbers, kOptional, "", 3},
                          {"rotation", Kind::numbers, kOptional, "", 4},
                          {"scale", Kind::numbers, kOptional, "", 3},
                          {"weights", Kind::numbers},
                          {"name", Kind::text},
                          {"extensions", Kind::object_map, kOptional, "", 0, kNodeExtensions}};
constexpr Rule kScene[] = {
    {"nodes", Kind::indices, kOptional, "nodes"}, {"name", Kind::text}, {"extensions", Kind::object_map}};

constexpr Rule kTextureTransform[] = {{"offset", Kind::numbers, kOptional, "", 2},
                                      {"rotation", Kind::number},
                                      {"scale", Kind::numbers, kOptional, "", 2},
                                      {"texCoord", Kind::count}};
constexpr Rule kTextureExtensions[] = {
    {"KHR_texture_transform", Kind::object, kOptional, "", 0, kTextureTransform}};
constexpr Rule kTextureInfo[] = {{"index", Kind::index, kRequired, "textures"},
                                 {"texCoord", Kind::count},
                                 {"scale", Kind::number},
                                 {"strength", Kind::number},
                                 {"extensions", Kind::object_map, kOptional, "", 0, kTextureExtensions}};
constexpr Rule kPbr[] = {{"baseColorFactor", Kind::numbers, kOptional, "", 4},
                         {"metallicFactor", Kind::number},
                         {"roughnessFactor", Kind::number},
                         {"baseColorTexture", Kind::object, kOptional, "", 0, kTextureInfo},
                         {"metallicRoughnessTexture", Kind::object, kOptional, "", 0, kTextureInfo},
                         {"extensions", Kind::object_map}};
constexpr Rule kEmissiveStrength[] = {{"emissiveStrength", Kind::number}};
constexpr Rule kMaterialExtensions[] = {
    {"KHR_materials_emissive_strength", Kind::object, kOptional, "", 0, kEmissiveStrength}};
constexpr Rule kMaterial[] = {{"pbrMetallicRoughness", Kind::object, kOptional, "", 0, kPbr},
                              {"normalTexture", Kind::object, kOptional, "", 0, kTextureInfo},
                              {"occlusionTexture", Kind::object, kOptional, "", 0, kTextureInfo},
                              {"emissiveTexture", Kind::object, kOptional, "", 0, kTextureInfo},
                              {"emissiveFactor", Kind::numbers, kOptional, "", 3},
                              {"alphaMode", Kind::text},
                              {"alphaCutoff", Kind::number},
                              {"doubleSided", Kind::boolean},
                              {"name", Kind::text},
                              {"extensions", Kind::object_map, kOptional, "", 0, kMaterialExtensions}};

constexpr Rule kTexture[] = {{"source", Kind::index, kOptional, "images"},
                             {"sampler", Kind::index, kOptional, "samplers"},
                             {"name", Kind::text},
                             {"extensions", Kind::object_map}};
constexpr Rule kImage[] = {{"uri", Kind::text},
                           {"mimeType", Kind::text},
                           {"name", Kind::text},
                           {"bufferView", Kind::index, kOptional, "bufferViews"},
                           {"extensions", Kind::object_map}};
constexpr Rule kSampler[] = {{"magFilter", Kind::count}, {"minFilter", Kind::count},
                             {"wrapS", Kind::count},     {"wrapT", Kind::count},
                             {"name", Kind::text},       {"extensions", Kind::object_map}};

constexpr Rule kSpot[] = {{"innerConeAngle", Kind::number}, {"outerConeAngle", Kind::number}};
constexpr Rule kLight[] = {{"type", Kind::text, kRequired},
                           {"color", Kind::numbers, kOptional, "", 3},
                           {"intensity", Kind::number},
                           {"range", Kind::number},
                           {"name", Kind::text},
                           {"spot", Kind::object, kOptional, "", 0, kSpot}};
constexpr Rule kLights[] = {{"lights", Kind::objects, kRequired, "", 0, kLight}};
constexpr Rule kRootExtensions[] = {{"KHR_lights_punctual", Kind::object, kOptional, "", 0, kLights}};

constexpr Rule kRoot[] = {{"asset", Kind::object, kRequired, "", 0, kAnyExtension},
                          {"extensionsUsed", Kind::texts},
                          {"extensionsRequired", Kind::texts},
                          {"scene", Kind::index, kOptional, "scenes"},
                          {"scenes", Kind::objects, kOptional, "", 0, kScene},
                          {"nodes", Kind::objects, kOptional, "", 0, kNode},
                          {"meshes", Kind::objects, kOptional, "", 0, kMesh},
                          {"accessors", Kind::objects, kOptional, "", 0, kAccessor},
                          {"bufferViews", Kind::objects, kOptional, "", 0, kBufferView},
                          {"buffers", Kind::objects, kOptional, "", 0, kBuffer},
                          {"materials", Kind::objects, kOptional, "", 0, kMaterial},
                          {"textures", Kind::objects, kOptional, "", 0, kTexture},
                          {"images", Kind::objects, kOptional, "", 0, kImage},
                          {"samplers", Kind::objects, kOptional, "", 0, kSampler},
                          {"cameras", Kind::values},
                          {"skins", Kind::objects, kOptional, "", 0, kAnyExtension},
                          {"animations", Kind::objects, kOptional, "", 0, kAnyExtension},
                          {"extensions", Kind::object_map, kOptional, "", 0, kRootExtensions}};

}  // namespace

std::span<const Rule> root_rules() { return kRoot; }

}  // namespace hwsim::pipeline::gltf
