// The player of pose tracks: lists the frames of a recording when it opens it, and decodes them on demand. It reads
// track chunks only, so it opens recordings of other versions whose state it cannot read.
#include "base/container/flat_map.h"
#include "io/chunk/chunks.h"
#include "io/track/soft_coder.h"
#include "io/track/track_coder.h"
#include "io/track/track_format.h"

#include <gyre/track.h>

namespace gyre {

namespace {

struct ListedFrame {
  std::span<const std::byte> payload;
  std::span<const std::byte> vertices;  // empty: there is no soft matter
  std::size_t keyframe = 0;             // the last one up to this frame
};

// Appends an item that `read` fills in. False if that fails.
template <class Item, class Read>
bool append(std::vector<Item>& items, Read&& read) {
  Item item;
  const bool good = read(item);
  if (good) items.push_back(std::move(item));
  return good;
}

std::uint64_t label_key(std::uint32_t index, std::uint16_t generation) {
  return std::uint64_t(index) << 16 | generation;
}

// Names and colours by id; the last label of an id holds.
struct LabelTable {
  std::vector<StoredLabel> labels;
  FlatMap<std::uint32_t> numbers;

  bool read(std::span<const std::byte> payload) {
    if (!append(labels, [&](StoredLabel& label) { return read_track_label(payload, label); })) return false;
    numbers.insert(label_key(labels.back().index, labels.back().generation),
                   std::uint32_t(labels.size() - 1));
    return true;
  }
  TrackLabel find(std::uint32_t index, std::uint16_t generation) const {
    const std::uint32_t* const number = numbers.find(label_key(index, generation));
    if (number == nullptr) return {};
    return {labels[*number].name, labels[*number].colors};
  }
};

}  // namespace

struct PoseTrack::Reader {
  std::vector<std::byte> bytes;
  TrackStart start;
  std::vector<Geometry> geometry;
  std::vector<TrackModel> models;
  std::vector<TrackSoft> surfaces;
  std::vector<std::uint32_t> vertex_counts;  // of the surfaces
  LabelTable labels, soft_labels;
  std::vector<StoredNote> notes;
  std::vector<ListedFrame> frames;
  std::span<const std::byte> vertices;  // for the frame that follows
  bool started = false;
  bool closed = false;

  // The frame that `decoded` holds, or nothing.
  static constexpr std::size_t kNone = SIZE_MAX;
  std::vector<TrackedBody> bodies;
  std::vector<TrackedSoft> softs;
  std::size_t decoded = kNone;

  // The present frame.
  std::size_t position = 0;
  FrameHead head;
  std::vector<BodyId> ids;
  std::vector<Pose> poses;
  std::vector<std::uint8_t> awake;
  std::vector<std::uint32_t> model_of;
  std::vector<SoftId> soft_ids;
  std::vector<std::uint32_t> surface_of;
  std::vector<std::size_t> vertex_ends;  // of each in `places`
  std::vector<DVec3> places;

  bool read_chunk(const Chunk& chunk, Error& why);
  bool read_start(const Chunk& chunk, Error& why);
  bool read_frame_chunk(const Chunk& chunk);
  bool decode(std::size_t frame);
  void publish(std::size_t frame);
  void publish_softs();
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
  const bool key = chunk.kind == ChunkKind::track_keyframe;
  if (number == 0 && !key) return false;
  frames.push_back({chunk.payload, std::exchange(vertices, {}), key ? number : frames.back().keyframe});
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
    case ChunkKind::track_soft:
      if (!append(surfaces, [&](TrackSoft& soft) { return read_track_soft(chunk.payload, soft); }))
        return false;
      vertex_counts.push_back(surfaces.back().vertices);
      return true;
    case ChunkKind::track_vertices:
      vertices = chunk.payload;
      return true;
    case ChunkKind::track_label:
      return labels.read(chunk.payload);
    case ChunkKind::track_soft_label:
      return soft_labels.read(chunk.payload);
    case ChunkKind::track_note:
      return append(notes, [&](StoredNote& note) { return read_track_note(chunk.payload, note); });
    case ChunkKind::end:
      closed = true;
      return true;
    default:
      return true;
  }
}

// Decodes `bodies` and `softs` up to the frame, from the present frame or from a keyframe.
bool PoseTrack::Reader::decode(std::size_t frame) {
  const std::size_t keyframe = frames[frame].keyframe;
  std::size_t next = decoded != kNone && decoded >= keyframe && decoded <= frame ? decoded + 1 : keyframe;
  FrameDecoder decoder(std::uint32_t(models.size()), start.steps);
  for (; next <= frame; ++next) {
    const ListedFrame& listed = frames[next];
    if (next == listed.keyframe) bodies.clear();
    if (next == listed.keyframe || listed.vertices.empty()) softs.clear();
    decoded = kNone;
    if (!listed.vertices.empty() && !decode_softs(listed.vertices, vertex_counts, softs)) return false;
    if (!decoder.decode(listed.payload.subspan(kFrameHeadBytes), bodies)) return false;
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
  publish_softs();
}

void PoseTrack::Reader::publish_softs() {
  soft_ids.clear();
  surface_of.clear();
  vertex_ends.clear();
  places.clear();
  const double metre = power_of_two(-start.steps.position_bits);
  for (const TrackedSoft& soft : softs) {
    soft_ids.push_back({soft.index, soft.generation, 0});
    surface_of.push_back(soft.surface);
    for (const RoundedVertex& vertex : soft.now)
      places.push_back({double(vertex[0]) * metre, double(vertex[1]) * metre, double(vertex[2]) * metre});
    vertex_ends.push_back(places.size());
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
std::span<const TrackSoft> PoseTrack::softs() const { return reader_->surfaces; }

TrackLabel PoseTrack::label(BodyId body) const { return reader_->labels.find(body.index, body.generation); }
TrackLabel PoseTrack::soft_label(SoftId soft) const {
  return reader_->soft_labels.find(soft.index, soft.generation);
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
  return {r.head.step, r.head.time,        r.ids,      r.poses,      r.awake,
          r.model_of,  r.head.set_version, r.soft_ids, r.surface_of, r.places};
}

std::span<const DVec3> PoseTrack::soft_vertices(std::size_t i) const {
  const Reader& r = *reader_;
  if (i >= r.vertex_ends.size()) return {};
  const std::size_t begin = i == 0 ? 0 : r.vertex_ends[i - 1];
  return std::span(r.places).subspan(begin, r.vertex_ends[i] - begin);
}

}  // namespace gyre
