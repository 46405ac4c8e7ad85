// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/yaml_value.h"

#include <algorithm>
#include <utility>

#include "config/yaml.h"
#include "drive/profile/numbers.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
class Converter
{
public:
  Converter(std::string source, bool with_lines) : source_(std::move(source)), with_lines_(with_lines)
  {
  }

  YamlValue convert(const config::YamlNode& node) const
  {
    YamlValue value;
    value.where = where(node.line);
    switch (node.kind)
    {
      case config::YamlNode::Kind::Scalar:
        value.scalar = node.scalar;
        value.text = node.scalar.text;
        value.kind = node.scalar.type == config::Scalar::Type::Null ? YamlValue::Kind::Empty : YamlValue::Kind::Scalar;
        break;
      case config::YamlNode::Kind::List:
        value.kind = YamlValue::Kind::List;
        for (const config::YamlNode& item : node.items)
        {
          value.items.push_back(convert(item));
        }
        break;
      case config::YamlNode::Kind::Map:
        value.kind = YamlValue::Kind::Map;
        for (const config::YamlEntry& entry : node.entries)
        {
          value.entries.push_back({ entry.key.text, where(entry.line), convert(entry.value) });
        }
        break;
    }
    return value;
  }

  std::string where(int line) const
  {
    return with_lines_ && line > 0 ? source_ + ":" + std::to_string(line) : source_;
  }

private:
  std::string source_;
  bool with_lines_;
};
}  // namespace

YamlValue* YamlValue::find(const std::string& key)
{
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&key](const YamlEntry& entry) { return sameKey(entry.key, key); });
  return found == entries.end() ? nullptr : &found->value;
}

const YamlValue* YamlValue::find(const std::string& key) const
{
  return const_cast<YamlValue*>(this)->find(key);
}

void YamlValue::erase(const std::string& key)
{
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [&key](const YamlEntry& entry) { return sameKey(entry.key, key); }),
                entries.end());
}

bool sameKey(const std::string& a, const std::string& b)
{
  if (a == b)
  {
    return true;
  }
  // Only numbers can be spelled in two ways.
  const auto number = parseInteger(a);
  return number && number == parseInteger(b);
}

std::optional<YamlValue> parseYaml(const std::string& text, const std::string& source, bool with_lines,
                                   Problems& problems)
{
  const Converter converter(source, with_lines);
  std::vector<config::YamlProblem> mistakes;
  const auto tree = config::readYaml(text, mistakes);
  for (const config::YamlProblem& mistake : mistakes)
  {
    problems.add(converter.where(mistake.line), mistake.path, mistake.what);
  }
  return tree ? std::optional<YamlValue>(converter.convert(*tree)) : std::nullopt;
}

std::optional<std::string> readTextFile(const std::string& path, Problems& problems)
{
  std::string error;
  auto text = config::readTextFile(path, error);
  if (!text)
  {
    problems.add(path, "", error);
  }
  return text;
}
}  // namespace drive
}  // namespace inverter_bus
