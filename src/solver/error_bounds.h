// How much of what is wrong with a joint is taken back at once.
#pragma once

namespace gyre {

// What a joint does not allow is taken back as if it were no more than this.
struct ErrorBounds {
  float point;  // m
  float turn;   // rad
};

// Bodies that are joined, or let go by what held them, far from where the joint would have them do not strike out.
constexpr ErrorBounds kMostErrors{0.1f, 0.2f};
// Before contacts are solved: they answer what is taken back as if it were a load, and keep that answer. Of small errors they must,
// or a rope would slip round a drum by what it gives; but limbs that are wedged in a heap pressed each other with tons.
constexpr ErrorBounds kErrorsBeforeContacts{0.5e-3f, 5.0e-3f};
constexpr ErrorBounds kNoErrors{0.0f, 0.0f};

}  // namespace gyre
