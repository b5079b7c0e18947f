// The player of pose tracks: lists the frames of a recording when it opens it, and decodes them on demand. It reads
// track chunks only, so it opens recordings of other versions whose state it cannot read.
#include "base/container/flat_map.h"
#include "io/chunk/chunks.h"
#include "io/track/track_coder.h"
#include "io/track/track_format.h"

#include <gyre/track.h>

namespace gyre {

namespace {

struct ListedFrame {
  std::span<const std::byte> payload;
  std::size_t keyframe = 0;  // the last one up to this frame
};

// Appends an item that `read` fills in. False if that fails.
template <class Item, class Read>
bool append(std::vector<Item>& items, Read&& read) {
  Item item;
  const bool good = read(item);
  if (good) items.push_back(std::move(item));
  return good;
}

std::uint64_t label_key(BodyId body) { return std::uint64_t(body.index) << 16 | body.generation; }

}  // namespace

struct PoseTrack::Reader {
  std::vector<std::byte> bytes;
  TrackStart start;
  std::vector<Geometry> geometry;
  std::vector<TrackModel> models;
  std::vector<StoredLabel> labels;
  FlatMap<std::uint32_t> label_of;  // by body: its last label
  std::vector<StoredNote> notes;
  std::vector<ListedFrame> frames;
  bool started = false;
  bool closed = false;

  // The bodies of frame `decoded`, or of none.
  static constexpr std::size_t kNone = SIZE_MAX;
  std::vector<TrackedBody> bodies;
  std::size_t decoded = kNone;

  // The present frame.
  std::size_t position = 0;
  FrameHead head;
  std::vector<BodyId> ids;
  std::vector<Pose> poses;
  std::vector<std::uint8_t> awake;
  std::vector<std::uint32_t> model_of;

  bool read_chunk(const Chunk& chunk, Error& why);
  bool read_start(const Chunk& chunk, Error& why);
  bool read_frame_chunk(const Chunk& chunk);
  bool decode(std::size_t frame);
  void publish(std::size_t frame);
};

bool PoseTrack::Reader::read_start(const Chunk& chunk, Error& why) {
  if (started) return false;
  why = read_track_start(chunk.payload, start);
  started = why.ok();
  return started;
}

bool PoseTrack::Reader::read_frame_chunk(const Chunk& chunk) {
  if (!started || chunk.payload.size() < kFrameHeadBytes) return false;
  const std::size_t number = frames.size();
  if (chunk.kind == ChunkKind::track_keyframe) {
    frames.push_back({chunk.payload, number});
    return true;
  }
  if (number == 0) return false;
  frames.push_back({chunk.payload, frames.back().keyframe});
  return true;
}

// False ends the reading. The frames before can be viewed.
bool PoseTrack::Reader::read_chunk(const Chunk& chunk, Error& why) {
  if (closed) return false;
  switch (chunk.kind) {
    case ChunkKind::track_start:
      return read_start(chunk, why);
    case ChunkKind::track_keyframe:
    case ChunkKind::track_frame:
      return read_frame_chunk(chunk);
    case ChunkKind::track_geometry: {
      const Result<Geometry> read = read_track_geometry(chunk.payload);
      if (read) geometry.push_back(*read);
      return read.has_value();
    }
    case ChunkKind::track_model:
      return append(models,
                    [&](TrackModel& model) { return read_track_model(chunk.payload, geometry, model); });
    case ChunkKind::track_label:
      if (!append(labels, [&](StoredLabel& label) { return read_track_label(chunk.payload, label); }))
        return false;
      label_of.insert(label_key(labels.back().body), std::uint32_t(labels.size() - 1));
      return true;
    case ChunkKind::track_note:
      return append(notes, [&](StoredNote& note) { return read_track_note(chunk.payload, note); });
    case ChunkKind::end:
      closed = true;
      return true;
    default:
      return true;
  }
}

// Decodes `bodies` up to the frame, from the present frame or from a keyframe.
bool PoseTrack::Reader::decode(std::size_t frame) {
  const std::size_t keyframe = frames[frame].keyframe;
  std::size_t next = decoded != kNone && decoded >= keyframe && decoded <= frame ? decoded + 1 : keyframe;
  FrameDecoder decoder(std::uint32_t(models.size()), start.steps);
  for (; next <= frame; ++next) {
    if (next == frames[next].keyframe) bodies.clear();
    decoded = kNone;
    if (!decoder.decode(frames[next].payload.subspan(kFrameHeadBytes), bodies)) return false;
    decoded = next;
  }
  return true;
}

void PoseTrack::Reader::publish(std::size_t frame) {
  position = frame;
  head = read_frame_head(frames[frame].payload);
  ids.clear();
  poses.clear();
  awake.clear();
  model_of.clear();
  for (const TrackedBody& body : bodies) {
    ids.push_back({body.index, body.generation, 0});
    poses.push_back(unrounded(body.pose.now, start.steps));
    awake.push_back(body.awake);
    model_of.push_back(body.model);
  }
}

PoseTrack::PoseTrack(std::unique_ptr<Reader> reader) : reader_(std::move(reader)) {}
PoseTrack::~PoseTrack() = default;
PoseTrack::PoseTrack(PoseTrack&&) noexcept = default;
PoseTrack& PoseTrack::operator=(PoseTrack&&) noexcept = default;

Result<PoseTrack> PoseTrack::open(std::vector<std::byte> bytes) {
  auto reader = std::make_unique<Reader>();
  reader->bytes = std::move(bytes);
  ChunkReader chunks(reader->bytes);
  Error why = chunks.read_header();
  if (why) return why;
  Chunk chunk;
  while (chunks.next(chunk) && reader->read_chunk(chunk, why)) {
  }
  if (why) return why;
  if (reader->frames.empty()) {
    if (reader->closed && !reader->started) {
      return make_error(ErrorCode::unsupported,
                        "recording: it holds no poses to look at; it can only be played");
    }
    return make_error(ErrorCode::invalid_data, "recording: its first frame is missing or damaged");
  }
  if (!reader->decode(0)) {
    return make_error(ErrorCode::invalid_data, "recording: its first frame holds what it cannot");
  }
  reader->publish(0);
  return PoseTrack(std::move(reader));
}

std::size_t PoseTrack::frame_count() const { return reader_->frames.size(); }
bool PoseTrack::truncated() const { return !reader_->closed; }

double PoseTrack::time(std::size_t frame) const {
  return frame < frame_count() ? read_frame_head(reader_->frames[frame].payload).time : 0.0;
}
std::uint64_t PoseTrack::step(std::size_t frame) const {
  return frame < frame_count() ? read_frame_head(reader_->frames[frame].payload).step : 0;
}

TrackAccuracy PoseTrack::accuracy() const { return accuracy_of(reader_->start.steps); }
std::span<const TrackModel> PoseTrack::models() const { return reader_->models; }

TrackLabel PoseTrack::label(BodyId body) const {
  const std::uint32_t* const number = reader_->label_of.find(label_key(body));
  if (number == nullptr) return {};
  const StoredLabel& label = reader_->labels[*number];
  return {label.name, label.colors};
}

std::string_view PoseTrack::note(std::string_view key) const {
  for (const StoredNote& note : reader_->notes) {
    if (note.key == key) return note.text;
  }
  return {};
}

Error PoseTrack::seek(std::size_t frame) {
  if (frame >= frame_count()) {
    return make_error(ErrorCode::invalid_argument, "seek: frame %llu; the track has %llu",
                      static_cast<unsigned long long>(frame), static_cast<unsigned long long>(frame_count()));
  }
  if (!reader_->decode(frame)) {
    return make_error(ErrorCode::invalid_data,
                      "seek: frame %llu, or one that it follows from, holds what it cannot",
                      static_cast<unsigned long long>(frame));
  }
  reader_->publish(frame);
  return {};
}

std::size_t PoseTrack::position() const { return reader_->position; }

TrackFrame PoseTrack::frame() const {
  const Reader& r = *reader_;
  return {r.head.step, r.head.time, r.ids, r.poses, r.awake, r.model_of, r.head.set_version};
}

}  // namespace gyre
