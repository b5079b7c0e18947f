#include "soft/elements/vertex_split.h"

namespace gyre {

VertexSplitter::VertexSplitter(std::span<std::uint32_t> corners, int arity, std::uint32_t vertices)
    : corners_(corners), arity_(std::uint32_t(arity)) {
  begin_.assign(std::size_t(vertices) + 1, 0u);
  for (const std::uint32_t corner : corners) ++begin_[corner + 1];
  for (std::uint32_t v = 0; v < vertices; ++v) begin_[v + 1] += begin_[v];
  elements_.resize(corners.size());
  Array<std::uint32_t> next = begin_;
  for (std::size_t k = 0; k < corners.size(); ++k) elements_[next[corners[k]]++] = std::uint32_t(k) / arity_;
  for (std::uint32_t v = 0; v < vertices; ++v) source_.push_back(v);
}

std::span<const std::uint32_t> VertexSplitter::around(std::uint32_t vertex) {
  listed_.clear();
  const std::uint32_t source = source_[vertex];
  for (std::uint32_t k = begin_[source]; k < begin_[source + 1]; ++k) {
    bool has = false;
    for (std::uint32_t c = 0; c < arity_; ++c) has = has || corners_[elements_[k] * arity_ + c] == vertex;
    if (has) listed_.push_back(elements_[k]);
  }
  return listed_.view();
}

bool VertexSplitter::hang_together(std::uint32_t a, std::uint32_t b, std::uint32_t vertex) const {
  std::uint32_t common = 0;
  for (std::uint32_t i = 0; i < arity_; ++i) {
    const std::uint32_t corner = corners_[a * arity_ + i];
    if (corner == vertex) continue;
    for (std::uint32_t k = 0; k < arity_; ++k) common += corners_[b * arity_ + k] == corner ? 1 : 0;
  }
  return common + 2 >= arity_;
}

void VertexSplitter::split(std::uint32_t vertex, std::span<const std::uint8_t> beyond,
                           Array<std::uint32_t>& made) {
  around(vertex);
  group_.assign(listed_.size(), -1);
  int groups = 0;
  for (std::size_t first = 0; first < listed_.size(); ++first) {
    if (group_[first] >= 0) continue;
    group_[first] = groups;
    waiting_.clear();
    waiting_.push_back(std::uint32_t(first));
    while (!waiting_.empty()) {
      const std::uint32_t one = waiting_.back();
      waiting_.resize(waiting_.size() - 1);
      for (std::uint32_t other = 0; other < listed_.size(); ++other) {
        if (group_[other] >= 0 || beyond[other] != beyond[one] ||
            !hang_together(listed_[one], listed_[other], vertex))
          continue;
        group_[other] = groups;
        waiting_.push_back(other);
      }
    }
    ++groups;
  }
  for (int g = 1; g < groups; ++g) {
    const std::uint32_t number = vertices();
    source_.push_back(source_[vertex]);
    made.push_back(number);
    for (std::size_t i = 0; i < listed_.size(); ++i) {
      if (group_[i] != g) continue;
      for (std::uint32_t c = 0; c < arity_; ++c) {
        std::uint32_t& corner = corners_[listed_[i] * arity_ + c];
        if (corner != vertex) continue;
        corner = number;
        changes_.push_back({listed_[i] * arity_ + c, vertex});
      }
    }
  }
}

void VertexSplitter::undo(std::uint32_t vertices) {
  while (!changes_.empty() && corners_[changes_.back().place] >= vertices) {
    corners_[changes_.back().place] = changes_.back().before;
    changes_.resize(changes_.size() - 1);
  }
  source_.resize(vertices);
}

}  // namespace gyre
