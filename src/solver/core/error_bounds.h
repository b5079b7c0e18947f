// How much of what is wrong with a joint is taken back at once, and how much of its bend is asked for: of linkages one by one and side by
// side alike.
#pragma once

namespace gyre {

// What a joint does not allow is taken back as if it were no more than this.
struct ErrorBounds {
  float point;  // m
  float rotation;   // rad
};

// Bodies that are joined, or let go by what held them, far from where the joint would have them do not strike out.
constexpr ErrorBounds kMaxErrors{0.1f, 0.2f};
// Before contacts are solved: they answer what is taken back as if it were a load, and keep that answer. Of small errors they must,
// or a rope would slip round a drum by what it gives; but limbs that are wedged in a heap pressed each other with tons.
constexpr ErrorBounds kErrorsBeforeContacts{0.5e-3f, 5.0e-3f};
constexpr ErrorBounds kNoErrors{0.0f, 0.0f};
// rad. What a stop that turns is passed by is taken back as if it were no more than this: slower than what joints do not allow, since its axis
// turns meanwhile, and of what it gives some is kept then.
constexpr float kMaxLimitError = 0.1f;

// rad. Bodies that turn by less than the first in a sub-step do so along a straight line; of those that turn by more than the second, the
// rows ask for less and less of the bend: a whip's end then loses energy instead of gaining it.
constexpr float kMinBiasAngle = 1.0e-4f, kMaxBiasAngle = 0.3f;
// Bend that is not asked for, or that two solutions do not find, opens the joint in each sub-step anew. Errors of joints whose bodies
// turn by more than this (rad) are taken back the faster for it: wholly in a sub-step where they turn by far more.
constexpr float kFastErrorAngle = 0.15f;
// Bodies that turn by less than this in a part need not have lost what speed errors gave them before the next part asks for their bend.
constexpr float kSlowRotation = 0.05f;

// What joints that do no work may give in a sub-step, of the energy of motion that there was, before all of it is taken away: what the bend
// beyond the second order gives and takes in turn in a smooth swing is less. Until bodies have moved it may be more, since what the bend
// asks for goes away after that.
constexpr float kMaxEnergyGain = 1.0e-2f, kMaxEnergyGainAhead = 1.0f;

// Motors that hold a place or a speed without a frequency of their own give way by this share of what would move them freely, where they are
// solved with the equations of their linkage: ten times as much as those, which motors in conflict are not to break.
constexpr float kMotorCompliance = 1.0e-3f;

// Stops of a cone's twist rest where 1 + cos(swing) is less, from 143 degrees on: a limb that points straight back has no twist, and near
// there it changes by any amount at once.
constexpr float kMinTwistReported = 0.2f;
// rad. Smaller swing limits of a cone count as this.
constexpr float kMinSwingLimit = 1.0e-3f;
// Of stops that cannot be reached.
constexpr float kUnreachable = 1.0e9f;  // rad

// h^2 k / I up to which tension is left alone; kick and drift are stable up to 4.
constexpr float kGeometricStiffnessThreshold = 1.0f;

// Slop of springs.
constexpr double kSpringSlop = 4.0e-4;
// Slop of pushout.
constexpr double kPushoutSlopFactor = 1.5, kPushoutSlop = 6.0e-4;
// Share of pushout.
constexpr double kPushoutShare = 0.4;

}  // namespace gyre
