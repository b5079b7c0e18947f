// Reads studies. See study.h.
#include "sweep/study.h"

#include "scene/number_text.h"

#include <gyre/math.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gyre {
namespace {

constexpr std::uint64_t kMaxCases = 10'000'000;
constexpr double kLargest = 1e300;

SceneError wrong(const std::string& file, const std::string& pointer, const std::string& message) {
  return {file, 0, 0, pointer, message};
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw wrong(path, "", "cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// FNV-1a, 64 bits.
std::uint64_t text_hash(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

// The output function of SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
// Evenly in (0, 1).
double unit_number(std::uint64_t bits) { return (double(bits >> 11) + 0.5) * 0x1p-53; }

// Members of one object of the study, all of which must be known.
class Members {
 public:
  Members(const std::string& file, std::string pointer, const Json& object)
      : file_(file), pointer_(std::move(pointer)), object_(object) {
    if (!object.is_object()) fail("", "expected an object");
  }
  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    std::string place = pointer_;
    if (!key.empty()) append_pointer(place, key);
    throw wrong(file_, place, message);
  }
  const Json* find(const char* key) {
    known_.emplace_back(key);
    const auto it = object_.find(key);
    return it == object_.end() ? nullptr : &*it;
  }
  std::optional<std::string> text(const char* key) {
    const Json* const found = find(key);
    if (found == nullptr) return std::nullopt;
    if (!found->is_string()) fail(key, "expected a text");
    return found->get<std::string>();
  }
  std::optional<double> number(const char* key, double low, double high) {
    const Json* const found = find(key);
    if (found == nullptr) return std::nullopt;
    return number_in(key, *found, low, high);
  }
  double number_in(const char* key, const Json& value, double low, double high) const {
    if (!value.is_number()) fail(key, "expected a number");
    const double number = value.get<double>();
    if (!(number >= low && number <= high))
      fail(key,
           "found " + value.dump() + ", expected a number from " + rounded(low) + " to " + rounded(high));
    return number;
  }
  std::optional<std::uint64_t> whole(const char* key, double low, double high) {
    const std::optional<double> found = number(key, low, high);
    if (!found) return std::nullopt;
    if (std::floor(*found) != *found) fail(key, "expected a whole number");
    return std::uint64_t(*found);
  }
  void refuse_others() const {
    for (const auto& [key, value] : object_.items()) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) fail(key, "is not known here");
    }
  }

 private:
  const std::string& file_;
  std::string pointer_;
  const Json& object_;
  std::vector<std::string> known_;
};

void read_range(Members& in, const Json& range, StudyParameter& out) {
  if (!range.is_object() || !range.contains("from") || !range.contains("to") || !range.contains("count") ||
      range.size() != 3)
    in.fail("range", "expected an object of from, to and count");
  const double from = in.number_in("range", range["from"], -kLargest, kLargest),
               to = in.number_in("range", range["to"], -kLargest, kLargest);
  const double count = in.number_in("range", range["count"], 1, 1e6);
  if (std::floor(count) != count) in.fail("range", "expected a whole count");
  for (int i = 0; i < int(count); ++i)
    out.values.emplace_back(count > 1 ? from + (to - from) * i / (count - 1) : from);
}

void read_pair(Members& in, const char* key, const Json& pair, Spread spread, StudyParameter& out) {
  if (!pair.is_array() || pair.size() != 2) in.fail(key, "expected two numbers");
  out.spread = spread;
  out.low = in.number_in(key, pair[0], -kLargest, kLargest);
  out.high = in.number_in(key, pair[1], -kLargest, kLargest);
  if (spread == Spread::log_uniform && !(out.low > 0 && out.high > 0))
    in.fail(key, "expected two numbers above 0");
  if (spread == Spread::normal && !(out.high >= 0))
    in.fail(key, "expected a mean and a standard deviation of at least 0");
}

StudyParameter read_parameter(Members in, const Json& scene) {
  StudyParameter out;
  const Json* const pointer = in.find("pointer");
  if (pointer == nullptr) in.fail("pointer", "is missing: a JSON pointer into the scene, or a list of them");
  for (const Json& one : pointer->is_array() ? *pointer : Json::array({*pointer})) {
    if (!one.is_string()) in.fail("pointer", "expected a JSON pointer, such as \"/bodies/0/position/1\"");
    out.pointers.push_back(one.get<std::string>());
    try {
      const Json::json_pointer place(out.pointers.back());
      if (place.empty() || !scene.contains(place.parent_pointer()))
        in.fail("pointer", "the scene has no place " + out.pointers.back());
    } catch (const Json::exception&) {
      in.fail("pointer", "found " + one.dump() + ", expected a JSON pointer");
    }
  }
  if (out.pointers.empty()) in.fail("pointer", "expected at least one JSON pointer");
  out.name = in.text("name").value_or(out.pointers.front());
  int kinds = 0;
  const auto take = [&](const char* key) {
    const Json* const found = in.find(key);
    kinds += found != nullptr;
    return found;
  };
  if (const Json* const values = take("values")) {
    if (!values->is_array() || values->empty()) in.fail("values", "expected a list of at least one value");
    out.values.assign(values->begin(), values->end());
  }
  if (const Json* const range = take("range")) read_range(in, *range, out);
  if (const Json* const pair = take("uniform")) read_pair(in, "uniform", *pair, Spread::uniform, out);
  if (const Json* const pair = take("log_uniform"))
    read_pair(in, "log_uniform", *pair, Spread::log_uniform, out);
  if (const Json* const pair = take("normal")) read_pair(in, "normal", *pair, Spread::normal, out);
  if (kinds != 1) in.fail("", "expected one of values, range, uniform, log_uniform and normal");
  in.refuse_others();
  return out;
}

StudyReading read_reading(Members in) {
  static const std::vector<std::string> of_body{
      "position_x", "position_y",    "position_z", "velocity_x",   "velocity_y",     "velocity_z",
      "speed",      "angular_speed", "awake",      "impact_speed", "impact_impulse", "touches"};
  static const std::vector<std::string> of_joint{"joint_position", "joint_velocity", "joint_force",
                                                 "joint_torque", "broken"};
  static const std::vector<std::string> of_world{"energy",       "kinetic_energy", "max_penetration",
                                                 "awake_bodies", "contact_points", "broken_joints",
                                                 "hits"};
  const auto has = [](const std::vector<std::string>& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  StudyReading out;
  out.quantity = in.text("quantity").value_or("");
  const std::optional<std::string> body = in.text("body"), joint = in.text("joint");
  if (has(of_body, out.quantity)    ? !body || joint
      : has(of_joint, out.quantity) ? !joint || body
                                    : body || joint)
    in.fail("quantity", "this quantity is of a " + std::string(has(of_body, out.quantity)    ? "body"
                                                               : has(of_joint, out.quantity) ? "joint"
                                                                                             : "world"));
  if (!has(of_body, out.quantity) && !has(of_joint, out.quantity) && !has(of_world, out.quantity)) {
    std::string known;
    for (const auto* list : {&of_body, &of_joint, &of_world}) {
      for (const std::string& word : *list) known += (known.empty() ? "" : ", ") + word;
    }
    in.fail("quantity", "found '" + out.quantity + "', expected one of " + known);
  }
  out.object = body ? *body : joint.value_or("");
  static const char* const takes[] = {"end", "maximum", "minimum", "mean", "first_above", "count"};
  const bool is_countable = has({"touches", "hits", "broken_joints"}, out.quantity);
  const std::string take = in.text("take").value_or(is_countable ? "count" : "end");
  const auto it = std::find(std::begin(takes), std::end(takes), take);
  if (it == std::end(takes))
    in.fail("take", "found '" + take + "', expected end, maximum, minimum, mean, first_above or count");
  out.take = Take(it - std::begin(takes));
  if (out.take == Take::count && !is_countable)
    in.fail("take", "only touches, hits and broken_joints are counted");
  const std::optional<double> threshold = in.number("threshold", -kLargest, kLargest);
  if ((out.take == Take::first_above) != threshold.has_value())
    in.fail("threshold", "belongs to first_above, which needs it");
  out.threshold = threshold.value_or(0);
  out.name = in.text("name").value_or((out.object.empty() ? "" : out.object + " ") + out.quantity +
                                      (out.take == Take::end || out.take == Take::count ? "" : " " + take));
  in.refuse_others();
  return out;
}

void refuse_equal_names(const Members& in, const char* key, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(names.begin(), names.begin() + std::ptrdiff_t(i), names[i]) !=
        names.begin() + std::ptrdiff_t(i))
      in.fail(key, "two have the name '" + names[i] + "'");
  }
}

Study parse_study(const std::string& text, const std::string& path, ReadText read) {
  const Json root = parse_document(text, path, {});
  Members in(path, "", root);
  Study out;
  out.path = path;
  if (in.number("gyre_study", 1, 1) != 1.0) in.fail("gyre_study", "is missing, expected 1");
  const std::optional<std::string> scene = in.text("scene");
  if (!scene) in.fail("scene", "is missing: the path of a scene file, from the folder of the study");
  const std::filesystem::path scene_path = std::filesystem::path(path).parent_path() / *scene;
  out.scene_path = scene_path.string();
  out.scene_folder = scene_path.parent_path().string();
  const std::string scene_text = read(out.scene_path);
  out.scene = parse_document(scene_text, out.scene_path, {});
  out.duration = in.number("duration", 0, 1e9);
  out.steps = in.whole("steps", 0, 1e12);
  if (out.duration.has_value() == out.steps.has_value())
    in.fail("duration", "expected either duration or steps");
  out.seed = in.whole("seed", 0, 9e15).value_or(0);
  out.samples = in.whole("samples", 1, double(kMaxCases)).value_or(1);
  std::vector<std::string> names;
  double cases = double(out.samples);
  if (const Json* const list = in.find("parameters")) {
    if (!list->is_array()) in.fail("parameters", "expected a list");
    for (std::size_t i = 0; i < list->size(); ++i) {
      out.parameters.push_back(
          read_parameter({path, "/parameters/" + std::to_string(i), (*list)[i]}, out.scene));
      names.push_back(out.parameters.back().name);
      cases *= double(std::max<std::size_t>(1, out.parameters.back().values.size()));
      if (cases > double(kMaxCases))
        in.fail("parameters", "these make " + rounded(cases) + " cases, expected at most 1e7");
    }
  }
  refuse_equal_names(in, "parameters", names);
  names.clear();
  if (const Json* const list = in.find("readings")) {
    if (!list->is_array()) in.fail("readings", "expected a list");
    for (std::size_t i = 0; i < list->size(); ++i) {
      out.readings.push_back(read_reading({path, "/readings/" + std::to_string(i), (*list)[i]}));
      names.push_back(out.readings.back().name);
    }
  }
  if (out.readings.empty()) in.fail("readings", "expected at least one reading");
  refuse_equal_names(in, "readings", names);
  in.refuse_others();
  char mark[20];
  std::snprintf(mark, sizeof mark, "%016llx",
                static_cast<unsigned long long>(text_hash(text + '\0' + scene_text)));
  out.fingerprint = mark;
  return out;
}

}  // namespace

std::uint64_t Study::case_count() const {
  std::uint64_t count = samples;
  for (const StudyParameter& parameter : parameters)
    count *= std::max<std::size_t>(1, parameter.values.size());
  return count;
}

std::vector<Json> Study::values_of(std::uint64_t number) const {
  std::vector<Json> out(parameters.size());
  // The last list changes fastest among lists, and samples change faster than these.
  std::uint64_t place = number / samples;
  for (std::size_t i = parameters.size(); i-- > 0;) {
    const StudyParameter& parameter = parameters[i];
    if (parameter.spread == Spread::values) {
      out[i] = parameter.values[place % parameter.values.size()];
      place /= parameter.values.size();
      continue;
    }
    const std::uint64_t bits = mixed(mixed(mixed(seed) + number) + i);
    const double u = unit_number(mixed(bits)), v = unit_number(mixed(bits + 1));
    double value = parameter.low + u * (parameter.high - parameter.low);
    if (parameter.spread == Spread::log_uniform)
      value = parameter.low * std::exp(u * std::log(parameter.high / parameter.low));
    if (parameter.spread == Spread::normal)  // G. Box, M. Muller, 1958
      value = parameter.low + parameter.high * std::sqrt(-2 * std::log(u)) * std::cos(2 * kPiDouble * v);
    out[i] = value;
  }
  return out;
}

SceneResult<Study> read_study(const std::string& text, const std::string& path, ReadText read) {
  try {
    return parse_study(text, path, read);
  } catch (const SceneError& error) {
    return error;
  } catch (const std::exception& error) {
    return SceneError{path, 0, 0, "", error.what()};
  }
}

SceneResult<Study> load_study(const std::string& path) {
  try {
    return read_study(read_text(path), path, read_text);
  } catch (const SceneError& error) {
    return error;
  }
}

}  // namespace gyre
