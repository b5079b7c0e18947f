// A study: one scene, parameters that change it, and the readings that each case gives.
//
// In: a study file (docs/scaling.md). Out: its cases by number, each the scene as text with the parameters of the case put in. A case is a
// function of the study and its number alone.
#pragma once

#include "scene/json_document.h"
#include "scene/scene_runner.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gyre {

enum class Spread { values, uniform, log_uniform, normal };

struct StudyParameter {
  std::string name;
  std::vector<std::string> pointers;  // JSON pointers into the scene: all take the value
  Spread spread = Spread::values;
  std::vector<Json> values;  // of a list or range; every combination of these makes cases
  double low = 0, high = 0;  // of uniform and log_uniform: the bounds; of normal: mean and standard deviation
};

enum class Take { end, maximum, minimum, mean, first_above, count };

struct StudyReading {
  std::string name;
  std::string quantity;
  std::string object;  // body or joint; empty: the whole world
  Take take = Take::end;
  double threshold = 0;  // of first_above
};

struct Study {
  std::string path, scene_path, scene_folder;
  Json scene;
  std::optional<double> duration;  // s
  std::optional<std::uint64_t> steps;
  std::uint64_t seed = 0;
  std::uint64_t samples = 1;
  std::vector<StudyParameter> parameters;
  std::vector<StudyReading> readings;
  std::string fingerprint;  // of study and scene: results of another one do not count as done

  std::uint64_t case_count() const;
  // The value of each parameter, in order.
  std::vector<Json> values_of(std::uint64_t number) const;
};

SceneResult<Study> load_study(const std::string& path);
// The same from text. `read` gives the text of the scene, by its path, or throws a SceneError.
using ReadText = std::string (*)(const std::string& path);
SceneResult<Study> read_study(const std::string& text, const std::string& path, ReadText read);

// The result of a case: one line of JSON without the line break. Whatever goes wrong with the case is told in its "error".
std::string run_case(const Study& study, std::uint64_t number);

}  // namespace gyre
