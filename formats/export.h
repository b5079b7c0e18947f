// Scenes and recordings to files of other programs: glTF 2.0 with its physics extensions, USD text, VTK.
//
// In: a scene whose convex decompositions are split (open_split_scene), or the pose track of a recording. Out: the text or bytes of the
// file, and notes with everything that the format does not have and that was left out.
#pragma once

#include "scene/scene.h"
#include "scene/scene_error.h"

#include <gyre/track.h>

#include <string>
#include <vector>

namespace gyre {

struct ExportedFile {
  std::string bytes;
  std::vector<std::string> notes;  // one a line
};

// KHR_physics_rigid_bodies and KHR_implicit_shapes. Members of the scene that glTF lacks stand in `extras.gyre` (docs/formats.md), so that
// the file reads back as the same scene. `binary`: a .glb file.
SceneResult<ExportedFile> export_gltf(const Scene& scene, const std::string& file, bool binary);

// A recording as an animated file: a node for each body, with one key for each frame in which it moved.
SceneResult<ExportedFile> export_gltf(PoseTrack& track, const std::string& file, bool binary);

// USD text (.usda) with the schema UsdPhysics: bodies, masses, shapes, materials, and joints of the kinds that it has.
SceneResult<ExportedFile> export_usd(const Scene& scene, const std::string& file);

}  // namespace gyre
