// Includes and default classes of MJCF. The format: DeepMind, MuJoCo documentation, "XML Reference". See mjcf_document.h.
#include "formats/mjcf_document.h"

#include <tinyxml2.h>

#include <algorithm>

namespace gyre {
namespace {

constexpr int kMaxIncludes = 200;
constexpr std::size_t kMaxIncludedBytes = std::size_t(64) << 20;
constexpr int kMaxModelDepth = 300;

using Attributes = std::map<std::string, std::string>;
using ClassDefaults = std::map<std::string, Attributes>;  // by element
constexpr const char* kOrientations[] = {"quat", "axisangle", "euler", "xyaxes", "zaxis"};

bool is_orientation(const std::string& name) {
  return std::any_of(std::begin(kOrientations), std::end(kOrientations),
                     [&](const char* word) { return name == word; });
}

tinyxml2::XMLElement* find_include(tinyxml2::XMLElement* root) {
  tinyxml2::XMLElement* element = root;
  while (element != nullptr) {
    if (std::string_view(element->Name()) == "include") return element;
    if (element->FirstChildElement() != nullptr) {
      element = element->FirstChildElement();
      continue;
    }
    while (element != nullptr && element != root && element->NextSiblingElement() == nullptr) {
      tinyxml2::XMLNode* const parent = element->Parent();
      element = parent == nullptr ? nullptr : parent->ToElement();
    }
    if (element == nullptr || element == root) return nullptr;
    element = element->NextSiblingElement();
  }
  return nullptr;
}

class DefaultClasses {
 public:
  explicit DefaultClasses(const Import& import) : import_(import) {}

  void read(tinyxml2::XMLElement* section, const ClassDefaults& inherited, const std::string& otherwise,
            int depth) {
    check_depth(section, depth);
    const char* const given = section->Attribute("class");
    const std::string name = given != nullptr ? given : otherwise;
    if (name.empty()) import_.fail("<default>: found no class", section->GetLineNum());
    ClassDefaults own = inherited;
    const auto merged = classes_.find(name);
    if (merged != classes_.end()) own = merged->second;  // a second section of the same class adds to it
    for (auto* e = section->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (std::string_view(e->Name()) == "default") continue;
      for (const tinyxml2::XMLAttribute* a = e->FirstAttribute(); a != nullptr; a = a->Next())
        own[e->Name()][a->Name()] = a->Value();
    }
    classes_[name] = own;
    if (classes_.size() > 1000)
      import_.fail("<default>: found more than 1000 classes", section->GetLineNum());
    for (auto* e = section->FirstChildElement("default"); e != nullptr; e = e->NextSiblingElement("default"))
      read(e, own, "", depth + 1);
  }

  void apply(tinyxml2::XMLElement* parent, const std::string& inherited, int depth) {
    check_depth(parent, depth);
    for (auto* e = parent->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (std::string_view(e->Name()) == "default") continue;
      const char* const child_class = e->Attribute("childclass");
      const std::string below = child_class != nullptr ? child_class : inherited;
      const char* const own = e->Attribute("class");
      set_missing(e, own != nullptr ? own : inherited);
      apply(e, below, depth + 1);
    }
  }

 private:
  void check_depth(const tinyxml2::XMLElement* element, int depth) const {
    if (depth > kMaxModelDepth) import_.fail("is nested deeper than 300 elements", element->GetLineNum());
  }

  void set_missing(tinyxml2::XMLElement* element, const std::string& name) const {
    const auto found = classes_.find(name);
    if (found == classes_.end()) {
      if (name != "main")
        import_.fail("<" + std::string(element->Name()) + ">: found no default class \"" + name + "\"",
                     element->GetLineNum());
      return;
    }
    const auto attributes = found->second.find(element->Name());
    if (attributes == found->second.end()) return;
    const bool is_turned = std::any_of(std::begin(kOrientations), std::end(kOrientations),
                                       [&](const char* word) { return element->Attribute(word) != nullptr; });
    for (const auto& [key, value] : attributes->second) {
      if (key == "class" || (is_turned && is_orientation(key))) continue;
      if (element->Attribute(key.c_str()) == nullptr) element->SetAttribute(key.c_str(), value.c_str());
    }
  }

  const Import& import_;
  std::map<std::string, ClassDefaults> classes_;
};

}  // namespace

void include_files(Import& import, tinyxml2::XMLDocument& document) {
  int count = 0;
  std::size_t bytes = 0;
  while (tinyxml2::XMLElement* const include = find_include(document.RootElement())) {
    const int line = include->GetLineNum();
    if (++count > kMaxIncludes) import.fail("includes more than 200 files", line);
    const char* const file = include->Attribute("file");
    if (file == nullptr) import.fail("<include>: found no file", line);
    const std::string text = import.read_file(file, import.folder, line);
    bytes += text.size();
    if (bytes > kMaxIncludedBytes) import.fail("includes more than 64 MiB", line);
    tinyxml2::XMLDocument part;
    parse_xml(import, text, file, part);
    tinyxml2::XMLNode* const parent = include->Parent();
    tinyxml2::XMLNode* after = include;
    for (auto* e = part.RootElement()->FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
      after = parent->InsertAfterChild(after, e->DeepClone(&document));
    parent->DeleteChild(include);
  }
  tinyxml2::XMLElement* const world = document.RootElement()->FirstChildElement("worldbody");
  while (world != nullptr) {
    tinyxml2::XMLElement* const other = world->NextSiblingElement("worldbody");
    if (other == nullptr) break;
    while (other->FirstChild() != nullptr) world->InsertEndChild(other->FirstChild());
    document.RootElement()->DeleteChild(other);
  }
}

void apply_defaults(const Import& import, tinyxml2::XMLDocument& document) {
  DefaultClasses classes(import);
  tinyxml2::XMLElement* const root = document.RootElement();
  for (auto* e = root->FirstChildElement("default"); e != nullptr; e = e->NextSiblingElement("default"))
    classes.read(e, {}, "main", 0);
  classes.apply(root, "main", 0);
}

}  // namespace gyre
