// Animation of a scene file.
#include <fmt/format.h>

#include "scene/scene_file.h"

namespace penumbra::scene_file {
namespace {

// Reads "loop" and "keyframes" of a track; calls each(keyframe) after checking that frames ascend.
template <class F>
Timeline read_timeline(const JsonNode& node, const std::vector<std::string>& keys, F each) {
  Timeline timeline;
  if (const auto loop = node.find("loop")) timeline.loop = loop->boolean();
  const JsonNode list = node.require("keyframes", "a track");
  std::vector<std::string> allowed = keys;
  allowed.emplace_back("frame");
  for (const JsonNode& key : list.items()) {
    key.allow_only(allowed, "a keyframe");
    const JsonNode frame = key.require("frame", "a keyframe");
    const double when = frame.number(0, 1e9);
    if (!timeline.frames.empty() && when <= timeline.frames.back())
      frame.fail(fmt::format("a frame after the one before it, {}", timeline.frames.back()));
    timeline.frames.push_back(when);
    each(key);
  }
  if (timeline.frames.empty()) list.fail("at least one keyframe");
  return timeline;
}

CameraTrack read_camera_track(const JsonNode& node, const SceneFile& scene) {
  node.allow_only({"camera", "loop", "keyframes"}, "a camera's track");
  CameraTrack track;
  track.camera = read_reference(node.require("camera", "a camera's track"), scene.camera_names(),
                                "a camera of this scene");
  const Camera& own = scene.cameras[track.camera];
  track.timeline = read_timeline(node, {"eye", "target"}, [&](const JsonNode& key) {
    const auto eye = key.find("eye"), target = key.find("target");
    track.eye.push_back(eye ? Vec3f(read_point(*eye)) : own.eye);
    track.target.push_back(target ? Vec3f(read_point(*target)) : own.target);
    const Vec3d forward = Vec3d(track.target.back()) - Vec3d(track.eye.back());
    if (!(length(cross(normalize(forward), Vec3d(own.up))) > 1e-6))
      key.complain("the camera looks along its up direction, or nowhere.");
  });
  return track;
}

LightTrack read_light_track(const JsonNode& node, const SceneFile& scene) {
  node.allow_only({"light", "loop", "keyframes"}, "a light's track");
  LightTrack track;
  track.light =
      read_reference(node.require("light", "a light's track"), scene.light_names(), "a light of this scene");
  const Light& own = scene.lights[track.light];
  std::vector<std::string> keys;
  const bool turns = own.kind == LightKind::directional || own.kind == LightKind::spot;
  if (own.kind != LightKind::directional) keys.emplace_back("center");
  if (turns) keys.emplace_back("direction");
  track.timeline = read_timeline(node, keys, [&](const JsonNode& key) {
    const auto center = key.find("center"), direction = key.find("direction");
    track.center.push_back(center ? Vec3f(read_point(*center)) : own.center);
    if (turns) track.direction.push_back(direction ? Vec3f(read_direction(*direction)) : own.direction);
  });
  return track;
}

InstanceTrack read_instance_track(const JsonNode& node, const SceneFile& scene) {
  node.allow_only({"instance", "axis", "pivot", "loop", "keyframes"}, "an instance's track");
  InstanceTrack track;
  track.instance = read_reference(node.require("instance", "an instance's track"), scene.instance_names(),
                                  "an instance of this scene");
  if (const auto axis = node.find("axis")) track.axis = read_direction(*axis);
  if (const auto pivot = node.find("pivot")) track.pivot = read_point(*pivot);
  track.timeline = read_timeline(node, {"translate", "degrees", "scale"}, [&](const JsonNode& key) {
    const auto translate = key.find("translate"), degrees = key.find("degrees"), scale = key.find("scale");
    track.translate.push_back(translate ? read_point(*translate) : Vec3d{});
    track.degrees.push_back(degrees ? degrees->number(-1e6, 1e6) : 0);
    track.scale.push_back(scale ? scale->number(1e-6, 1e6) : 1);
  });
  return track;
}

Deformation read_deformation(const JsonNode& node, const SceneFile& scene) {
  const std::string what = "a deformation";
  node.allow_only({"instance", "kind", "axis", "direction", "amplitude", "period", "wavelength"}, what);
  static const std::vector<std::string> axes = {"x", "y", "z"};
  Deformation d;
  d.instance =
      read_reference(node.require("instance", what), scene.instance_names(), "an instance of this scene");
  d.kind = static_cast<DeformationKind>(
      read_reference(node.require("kind", what), {"twist", "bend", "wave"}, "a kind of deformation"));
  if (const auto axis = node.find("axis")) d.axis = static_cast<int>(read_reference(*axis, axes, "an axis"));
  d.direction = (d.axis + 1) % 3;
  if (const auto direction = node.find("direction")) {
    d.direction = static_cast<int>(read_reference(*direction, axes, "an axis"));
    if (d.direction == d.axis) direction->fail("another axis than \"axis\"");
  }
  d.amplitude = node.require("amplitude", what).number(-1e6, 1e6);
  d.period = node.require("period", what).number(1e-3, 1e9);
  if (const auto wavelength = node.find("wavelength")) {
    if (d.kind != DeformationKind::wave) wavelength->complain("only a wave has a wavelength.");
    d.wavelength = wavelength->number(1e-6, 1e9);
  }
  return d;
}

template <class Track, class Read>
void read_tracks(const JsonNode& node, const char* key, std::vector<Track>& out, std::size_t Track::*target,
                 const SceneFile& scene, Read read) {
  const auto list = node.find(key);
  if (!list) return;
  for (const JsonNode& entry : list->items()) {
    Track track = read(entry, scene);
    for (const Track& other : out)
      if (other.*target == track.*target) entry.complain("it has a track already.");
    out.push_back(std::move(track));
  }
}

}  // namespace

Animation read_animation(const JsonNode& node, const SceneFile& scene) {
  node.allow_only({"cameras", "lights", "instances", "deformations"}, "an animation");
  Animation a;
  read_tracks(node, "cameras", a.cameras, &CameraTrack::camera, scene, read_camera_track);
  read_tracks(node, "lights", a.lights, &LightTrack::light, scene, read_light_track);
  read_tracks(node, "instances", a.instances, &InstanceTrack::instance, scene, read_instance_track);
  read_tracks(node, "deformations", a.deformations, &Deformation::instance, scene, read_deformation);
  return a;
}

}  // namespace penumbra::scene_file
