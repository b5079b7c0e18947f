// Recordings as files. See recording_file.h.
#include "recording_file.h"

#include "exit_code.h"
#include "scene/json_writer.h"
#include "scene/mesh_file.h"
#include "scene/number_text.h"

#include <gyre/replay.h>

#include <cstdio>
#include <cstring>
#include <optional>

namespace gyre {
namespace {

constexpr std::string_view kMagic = "GYREPLAY";

// The two forms that a recording may have; neither if both are damaged.
struct Forms {
  std::optional<Replay> replay;
  std::optional<PoseTrack> track;
  std::string replay_problem;
  std::size_t bytes = 0;
};

std::string type_word(BodyType type) {
  return type == BodyType::fixed ? "static" : type == BodyType::kinematic ? "kinematic" : "dynamic";
}

std::string text_of(Forms& forms) {
  std::string out = "recording, " + rounded(double(forms.bytes) / 1000.0, 4) + " kB\n";
  if (forms.replay) {
    Replay& replay = *forms.replay;
    const WorldStats counts = replay.world().stats();
    out += "replay  " + std::to_string(replay.step_count()) + " steps, begins with " +
           std::to_string(counts.bodies) + " bodies, " + std::to_string(counts.joints) + " joints\n";
  } else {
    out += "replay  none: " + forms.replay_problem + "\n";
  }
  if (!forms.track) return out + "track   none\n";
  PoseTrack& track = *forms.track;
  const std::size_t last = track.frame_count() - 1;
  out += "track   " + std::to_string(track.frame_count()) + " frames, " + rounded(track.time(0)) + " s to " +
         rounded(track.time(last)) + " s, positions within " + rounded(track.accuracy().position, 3) +
         " m, orientations within " + rounded(track.accuracy().orientation, 3) + " rad\n";
  if (track.truncated()) out += "note    the recording has no end; it is read up to its last whole step\n";
  const TrackFrame frame = track.frame();
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    const TrackModel& model = track.models()[frame.models[i]];
    out += "body \"" + std::string(track.label(frame.ids[i]).name) + "\", " + type_word(model.type) + ", " +
           std::to_string(model.shapes.size()) + (model.shapes.size() == 1 ? " shape\n" : " shapes\n");
  }
  return out;
}

std::string json_of(Forms& forms) {
  JsonWriter json;
  json.begin_object();
  json.field("bytes", std::int64_t(forms.bytes));
  json.key("replay");
  if (forms.replay) {
    json.begin_object(JsonLayout::one_line);
    json.field("steps", std::int64_t(forms.replay->step_count()));
    json.field("truncated", forms.replay->truncated());
    json.end_object();
  } else {
    json.null();
  }
  json.key("track");
  if (!forms.track) {
    json.null();
    json.end_object();
    return json.take();
  }
  PoseTrack& track = *forms.track;
  json.begin_object();
  json.field("frames", std::int64_t(track.frame_count()));
  json.field("begin", track.time(0));
  json.field("end", track.time(track.frame_count() - 1));
  json.field("truncated", track.truncated());
  json.field("position_accuracy", track.accuracy().position);
  json.field("orientation_accuracy", track.accuracy().orientation);
  json.key("bodies").begin_array();
  const TrackFrame frame = track.frame();
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    json.begin_object(JsonLayout::one_line);
    json.field("name", std::string(track.label(frame.ids[i]).name));
    json.field("type", type_word(track.models()[frame.models[i]].type));
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.end_object();
  return json.take();
}

}  // namespace

SceneLimits recording_limits() {
  SceneLimits limits;
  limits.file_bytes = std::size_t(1) << 32;
  return limits;
}

bool is_recording(const std::string& path) {
  char begin[8] = {};
  if (path == kStandardInput) {
    std::string bytes;
    return read_whole_file(path, recording_limits(), bytes).empty() && bytes.rfind(kMagic, 0) == 0;
  }
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  const bool whole = std::fread(begin, 1, sizeof begin, file) == sizeof begin;
  std::fclose(file);
  return whole && std::memcmp(begin, kMagic.data(), kMagic.size()) == 0;
}

std::string read_recording(const std::string& path, std::vector<std::byte>& bytes) {
  std::string text;
  const std::string problem = read_whole_file(path, recording_limits(), text);
  if (!problem.empty()) return problem;
  if (text.rfind(kMagic, 0) != 0) return "is no recording (*.gyrec); gyre simulate --record writes one";
  const auto* const data = reinterpret_cast<const std::byte*>(text.data());
  bytes.assign(data, data + text.size());
  return {};
}

int show_recording(const std::string& path, bool as_json) {
  std::vector<std::byte> bytes;
  const std::string problem = read_recording(path, bytes);
  const auto refuse = [&](const std::string& why) {
    std::fprintf(stderr, "gyre: %s: %s\n", path.c_str(), why.c_str());
    return kExitInvalid;
  };
  if (!problem.empty()) return refuse(problem);
  Forms forms;
  forms.bytes = bytes.size();
  Result<PoseTrack> track = PoseTrack::open(bytes);
  if (track) forms.track.emplace(*std::move(track));
  Result<Replay> replay = Replay::open(std::move(bytes));
  if (replay) {
    forms.replay.emplace(*std::move(replay));
  } else {
    forms.replay_problem = replay.error().message;
  }
  if (!forms.track && !forms.replay) return refuse(forms.replay_problem);
  const std::string text = as_json ? json_of(forms) : text_of(forms);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return kExitGood;
}

}  // namespace gyre
