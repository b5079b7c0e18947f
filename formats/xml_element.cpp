// Elements of XML documents. tinyxml2 parses: it knows the five entities of XML and no others, opens nothing, and refuses documents
// nested deeper than 100. See xml_element.h.
#include "formats/xml_element.h"

#include "scene/number_text.h"

#include <tinyxml2.h>

namespace gyre {
namespace {

constexpr double kLargestNumber = 1.0e12;
constexpr std::size_t kMaxXmlBytes = std::size_t(64) << 20;

}  // namespace

std::string XmlElement::name() const { return element_->Name(); }
int XmlElement::line() const { return element_->GetLineNum(); }

void XmlElement::fail(const std::string& message) const {
  import_->fail("<" + name() + ">: " + message, line());
}

XmlElement XmlElement::child(const char* name) const { return {element_->FirstChildElement(name), *import_}; }

XmlElement XmlElement::need_child(const char* name) const {
  const XmlElement found = child(name);
  if (!found) fail(std::string("found no <") + name + ">");
  return found;
}

std::vector<XmlElement> XmlElement::children() const {
  std::vector<XmlElement> out;
  for (auto* e = element_->FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    out.emplace_back(e, *import_);
  return out;
}
std::vector<XmlElement> XmlElement::children(const char* name) const {
  std::vector<XmlElement> out;
  for (auto* e = element_->FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name))
    out.emplace_back(e, *import_);
  return out;
}

const char* XmlElement::raw(const char* attribute) const { return element_->Attribute(attribute); }
bool XmlElement::has(const char* attribute) const { return raw(attribute) != nullptr; }

std::string XmlElement::text(const char* attribute, const std::string& otherwise) const {
  const char* const value = raw(attribute);
  return value != nullptr ? value : otherwise;
}

std::string XmlElement::need_text(const char* attribute) const {
  const char* const value = raw(attribute);
  if (value == nullptr || *value == '\0') fail(std::string("found no ") + attribute);
  return value;
}

std::vector<double> XmlElement::numbers(const char* attribute, std::size_t least, std::size_t most) const {
  std::vector<double> out;
  const char* const value = raw(attribute);
  if (value == nullptr) return out;
  std::string_view rest = value;
  const auto expected = [&] {
    fail(std::string("found ") + attribute + " \"" + std::string(value).substr(0, 60) + "\", expected " +
         (least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most)) +
         " finite numbers of at most 1e12");
  };
  for (;;) {
    const std::size_t begin = rest.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) break;
    rest.remove_prefix(begin);
    const std::size_t end = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    double number = 0;
    if (out.size() >= most || !parse_number(rest.substr(0, end), number) || absolute(number) > kLargestNumber)
      expected();
    out.push_back(number);
    rest.remove_prefix(end);
  }
  if (out.size() < least) expected();
  return out;
}

double XmlElement::number(const char* attribute, double otherwise) const {
  const std::vector<double> values = numbers(attribute, 1, 1);
  return values.empty() ? otherwise : values[0];
}
double XmlElement::need_number(const char* attribute) const {
  need_text(attribute);
  return number(attribute, 0);
}
double XmlElement::positive(const char* attribute) const {
  const double value = need_number(attribute);
  if (!(value > 0))
    fail(std::string("found ") + attribute + " " + text(attribute) + ", expected a number above 0");
  return value;
}

Vec3 XmlElement::vec3(const char* attribute, Vec3 otherwise) const {
  const std::vector<double> v = numbers(attribute, 3, 3);
  return v.empty() ? otherwise : Vec3{float(v[0]), float(v[1]), float(v[2])};
}

bool XmlElement::flag(const char* attribute, bool otherwise) const {
  const std::string word = text(attribute);
  if (word.empty()) return otherwise;
  if (word != "true" && word != "false")
    fail(std::string("found ") + attribute + " \"" + word + "\", expected true or false");
  return word == "true";
}

void parse_xml(const Import& import, std::string_view bytes, const std::string& file,
               tinyxml2::XMLDocument& document) {
  if (bytes.size() > kMaxXmlBytes) throw SceneError{file, 0, 0, "", "is larger than 64 MiB"};
  const tinyxml2::XMLError error = document.Parse(bytes.data(), bytes.size());
  if (error != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr) {
    const int line = document.ErrorLineNum();
    const std::string what =
        error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED ? "is nested too deep" : "is not well-formed XML";
    throw SceneError{file, line, line > 0 ? 1 : 0, "", what};
  }
  std::size_t elements = 0;
  for (const tinyxml2::XMLNode* node = document.RootElement(); node != nullptr;) {
    if (++elements > import.options.limits.values)
      throw SceneError{file, 0, 0, "", "has more elements than the limit"};
    if (node->FirstChild() != nullptr) {
      node = node->FirstChild();
      continue;
    }
    while (node != nullptr && node->NextSibling() == nullptr) node = node->Parent();
    if (node != nullptr) node = node->NextSibling();
  }
}

}  // namespace gyre
