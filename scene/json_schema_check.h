// Checks a JSON document against a JSON Schema, for tests: the part of draft 2020-12 that the scene schema uses. A keyword it
// does not know is a failure, so that nothing in the schema goes unchecked.
#pragma once

#include "scene/json_document.h"

#include <set>
#include <string>

namespace gyre {

class SchemaCheck {
 public:
  explicit SchemaCheck(const Json& schema) : root_(schema) {}

  // Empty if `value` is valid, otherwise what is wrong first.
  std::string check(const Json& value) {
    std::set<std::string> seen;
    return check(root_, value, "", seen);
  }

 private:
  using Seen = std::set<std::string>;  // members that some part of the schema has looked at

  static bool has_type(const std::string& type, const Json& v) {
    if (type == "object") return v.is_object();
    if (type == "array") return v.is_array();
    if (type == "string") return v.is_string();
    if (type == "boolean") return v.is_boolean();
    if (type == "null") return v.is_null();
    if (type == "number") return v.is_number();
    return v.is_number() && v.get<double>() == double(std::int64_t(v.get<double>()));
  }
  static bool has_any_type(const Json& types, const Json& v) {
    if (types.is_string()) return has_type(types.get<std::string>(), v);
    for (const Json& type : types) {
      if (has_type(type.get<std::string>(), v)) return true;
    }
    return false;
  }

  const Json& definition(const std::string& reference) const {
    return root_.at("$defs").at(reference.substr(std::string("#/$defs/").size()));
  }

  std::string check(const Json& schema, const Json& v, const std::string& at, Seen& seen) {
    if (schema.is_boolean()) return schema.get<bool>() ? "" : at + ": nothing is allowed here";
    for (auto rule = schema.begin(); rule != schema.end(); ++rule) {
      if (rule.key() == "unevaluatedProperties" || rule.key() == "additionalProperties") continue;
      const std::string problem = check_rule(schema, rule.key(), *rule, v, at, seen);
      if (!problem.empty()) return problem;
    }
    // After all others: these two look at what is left.
    for (const char* key : {"additionalProperties", "unevaluatedProperties"}) {
      if (!schema.contains(key) || !v.is_object()) continue;
      for (auto member = v.begin(); member != v.end(); ++member) {
        const bool known = std::string(key) == "additionalProperties"
                               ? schema.contains("properties") && schema["properties"].contains(member.key())
                               : seen.count(member.key()) > 0;
        if (known) continue;
        Seen inner;
        const std::string problem = check(schema[key], *member, at + "/" + member.key(), inner);
        if (!problem.empty()) return problem;
        seen.insert(member.key());
      }
    }
    return {};
  }

  std::string check_rule(const Json& schema, const std::string& key, const Json& rule, const Json& v,
                         const std::string& at, Seen& seen) {
    if (key == "$schema" || key == "$defs" || key == "title" || key == "description" || key == "default")
      return {};
    if (key == "$ref") return check(definition(rule.get<std::string>()), v, at, seen);
    if (key == "type") return has_any_type(rule, v) ? "" : at + ": wrong type";
    if (key == "const") return v == rule ? "" : at + ": not the constant";
    if (key == "enum") {
      for (const Json& word : rule) {
        if (word == v) return {};
      }
      return at + ": not one of the words";
    }
    if (key == "anyOf" || key == "oneOf" || key == "allOf") return check_several(key, rule, v, at, seen);
    if (key == "if") {
      Seen inner;
      return check(rule, v, at, inner).empty() ? check(schema.at("then"), v, at, seen) : "";
    }
    if (key == "then") return {};
    if (key == "required" || key == "properties" || key == "propertyNames") {
      return v.is_object() ? check_members(key, rule, v, at, seen) : "";
    }
    if (key == "items" || key == "minItems" || key == "maxItems")
      return v.is_array() ? check_items(key, rule, v, at) : "";
    if (key == "minLength" || key == "maxLength") {
      if (!v.is_string()) return {};
      const std::size_t size = v.get<std::string>().size();
      return (key == "minLength" ? size >= rule.get<std::size_t>() : size <= rule.get<std::size_t>())
                 ? ""
                 : at + ": length";
    }
    if (key == "pattern" && rule == "^#[0-9a-fA-F]{6}$") {  // the one pattern of the schema
      if (!v.is_string()) return {};
      const std::string& text = v.get_ref<const std::string&>();
      const bool good = text.size() == 7 && text[0] == '#' &&
                        text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
      return good ? "" : at + ": not a color";
    }
    return check_number(key, rule, v, at);
  }

  std::string check_several(const std::string& key, const Json& rules, const Json& v, const std::string& at,
                            Seen& seen) {
    std::size_t good = 0;
    std::string last;
    for (const Json& rule : rules) {
      Seen inner;
      const std::string problem = check(rule, v, at, inner);
      if (!problem.empty()) {
        last = problem;
        continue;
      }
      ++good;
      seen.insert(inner.begin(), inner.end());
    }
    if (key == "allOf") return good == rules.size() ? "" : last;
    if (key == "oneOf" && good > 1) return at + ": more than one alternative fits";
    return good > 0 ? "" : at + ": no alternative fits; the last: " + last;
  }

  std::string check_members(const std::string& key, const Json& rule, const Json& v, const std::string& at,
                            Seen& seen) {
    if (key == "required") {
      for (const Json& name : rule) {
        if (!v.contains(name.get<std::string>())) return at + "/" + name.get<std::string>() + ": missing";
      }
      return {};
    }
    for (auto member = v.begin(); member != v.end(); ++member) {
      Seen inner;
      if (key == "propertyNames") {
        const std::string problem = check(rule, Json(member.key()), at + "/" + member.key(), inner);
        if (!problem.empty()) return problem;
      } else if (rule.contains(member.key())) {
        seen.insert(member.key());
        const std::string problem = check(rule[member.key()], *member, at + "/" + member.key(), inner);
        if (!problem.empty()) return problem;
      }
    }
    return {};
  }

  std::string check_items(const std::string& key, const Json& rule, const Json& v, const std::string& at) {
    if (key == "minItems") return v.size() >= rule.get<std::size_t>() ? "" : at + ": too few";
    if (key == "maxItems") return v.size() <= rule.get<std::size_t>() ? "" : at + ": too many";
    for (std::size_t i = 0; i < v.size(); ++i) {
      Seen inner;
      const std::string problem = check(rule, v[i], at + "/" + std::to_string(i), inner);
      if (!problem.empty()) return problem;
    }
    return {};
  }

  static std::string check_number(const std::string& key, const Json& rule, const Json& v,
                                  const std::string& at) {
    const bool known =
        key == "minimum" || key == "maximum" || key == "exclusiveMinimum" || key == "exclusiveMaximum";
    if (!known) return at + ": the checker does not know the keyword " + key;
    if (!v.is_number()) return {};
    const double value = v.get<double>(), bound = rule.get<double>();
    const bool good = key == "minimum"            ? value >= bound
                      : key == "maximum"          ? value <= bound
                      : key == "exclusiveMinimum" ? value > bound
                                                  : value < bound;
    return good ? "" : at + ": out of range";
  }

  const Json& root_;
};

}  // namespace gyre
