// Checked access to elements of an XML document: every refusal names the line. Numbers are finite and at most 1e12 in size.
#pragma once

#include "formats/import_parts.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tinyxml2 {
class XMLElement;
class XMLDocument;
}  // namespace tinyxml2

namespace gyre {

class XmlElement {
 public:
  XmlElement() = default;
  XmlElement(const tinyxml2::XMLElement* element, const Import& import)
      : element_(element), import_(&import) {}

  explicit operator bool() const { return element_ != nullptr; }
  std::string name() const;
  int line() const;
  [[noreturn]] void fail(const std::string& message) const;

  XmlElement child(const char* name) const;  // the first; none: false
  XmlElement need_child(const char* name) const;
  std::vector<XmlElement> children() const;
  std::vector<XmlElement> children(const char* name) const;

  bool has(const char* attribute) const;
  std::string text(const char* attribute, const std::string& otherwise = "") const;
  std::string need_text(const char* attribute) const;
  // Numbers with spaces between them; `least` to `most` of them. Empty if the attribute is absent.
  std::vector<double> numbers(const char* attribute, std::size_t least, std::size_t most) const;
  double number(const char* attribute, double otherwise) const;
  double need_number(const char* attribute) const;
  double positive(const char* attribute) const;  // required, above 0
  Vec3 vec3(const char* attribute, Vec3 otherwise) const;
  bool flag(const char* attribute, bool otherwise) const;  // true or false

 private:
  const char* raw(const char* attribute) const;

  const tinyxml2::XMLElement* element_ = nullptr;
  const Import* import_ = nullptr;
};

// A document that is well formed and within the limits of the import; else a SceneError.
void parse_xml(const Import& import, std::string_view bytes, const std::string& file,
               tinyxml2::XMLDocument& document);

}  // namespace gyre
