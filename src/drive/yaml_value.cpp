// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "yaml_value.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>

#include <yaml-cpp/yaml.h>

#include "inverter_bus/drive/profile.h"
#include "numbers.h"
#include "yaml_measure.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// Deeper than any profile; an alias that contains itself would have no bottom.
constexpr int MAX_DEPTH = 20;
/// More than any profile; a few nested aliases can stand for billions of values.
constexpr std::size_t MAX_VALUES = 200000;

class Converter
{
public:
  Converter(std::string source, bool with_lines, Problems& problems)
    : source_(std::move(source)), with_lines_(with_lines), problems_(problems)
  {
  }

  YamlValue convert(const YAML::Node& node, const std::string& path, int depth)
  {
    YamlValue value;
    value.where = where(node.Mark());
    if (depth > MAX_DEPTH || ++values_ > MAX_VALUES)
    {
      fail(value.where, path, depth > MAX_DEPTH ? "nested too deeply" : "too many values");
      return value;
    }
    switch (node.Type())
    {
      case YAML::NodeType::Scalar:
        value.kind = YamlValue::Kind::Scalar;
        value.text = node.Scalar();
        value.quoted = node.Tag() == "!";
        break;
      case YAML::NodeType::Sequence:
        convertList(node, path, depth, value);
        break;
      case YAML::NodeType::Map:
        convertMap(node, path, depth, value);
        break;
      default:
        break;
    }
    return value;
  }

  std::string where(const YAML::Mark& mark) const
  {
    return with_lines_ && mark.line >= 0 ? source_ + ":" + std::to_string(mark.line + 1) : source_;
  }

private:
  void convertList(const YAML::Node& node, const std::string& path, int depth, YamlValue& value)
  {
    value.kind = YamlValue::Kind::List;
    for (std::size_t i = 0; i < node.size() && !failed_; ++i)
    {
      value.items.push_back(convert(node[i], path + "[" + std::to_string(i) + "]", depth + 1));
    }
  }

  /// 0x21 and 33 are the same key.
  static std::string canonical(const std::string& key)
  {
    const auto number = parseInteger(key);
    return number ? std::to_string(*number) : key;
  }

  void convertMap(const YAML::Node& node, const std::string& path, int depth, YamlValue& value)
  {
    value.kind = YamlValue::Kind::Map;
    std::set<std::string> seen;
    for (auto entry = node.begin(); entry != node.end() && !failed_; ++entry)
    {
      const std::string key_where = where(entry->first.Mark());
      if (!entry->first.IsScalar())
      {
        problems_.add(key_where, path, "a key must be a plain word or number");
        continue;
      }
      const std::string key = entry->first.Scalar();
      std::string key_path = path;
      key_path.append(path.empty() ? "" : ".").append(key);
      if (!seen.insert(canonical(key)).second)
      {
        problems_.add(key_where, key_path, "duplicate key: allowed once");
        continue;
      }
      value.entries.push_back({ key, key_where, convert(entry->second, key_path, depth + 1) });
      // A map or an empty value "stands" on the line after its key for yaml-cpp; people look for the key.
      value.entries.back().value.where = key_where;
    }
  }

  void fail(const std::string& where, const std::string& path, const std::string& what)
  {
    if (!failed_)
    {
      problems_.add(where, path, what);
    }
    failed_ = true;
  }

  std::string source_;
  bool with_lines_;
  Problems& problems_;
  std::size_t values_ = 0;
  bool failed_ = false;
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

unsigned yamlDepth(const std::string& yaml)
{
  unsigned flow = 0;
  unsigned deepest_flow = 0;
  unsigned blocks = 0;
  unsigned deepest_blocks = 0;
  bool at_line_start = true;
  for (const char c : yaml)
  {
    const bool opens = c == '[' || c == '{';
    flow += opens ? 1 : 0;
    flow -= (c == ']' || c == '}') && flow > 0 ? 1 : 0;
    deepest_flow = std::max(deepest_flow, flow);
    // Each space of indentation, and each "- " or "? " on one line, may open a block.
    at_line_start = c == '\n' || (at_line_start && (c == ' ' || c == '-' || c == '?' || c == '\t'));
    blocks = c == '\n' ? 0 : blocks + (at_line_start ? 1 : 0);
    deepest_blocks = std::max(deepest_blocks, blocks);
  }
  // Two characters at least for each block.
  return std::max(deepest_flow, deepest_blocks / 2);
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
  Converter converter(source, with_lines, problems);
  if (yamlDepth(text) > DEEPEST_YAML)
  {
    problems.add(source, "", "nested too deeply");
    return std::nullopt;
  }
  try
  {
    const int documents = countDocuments(text);
    if (documents != 1)
    {
      problems.add(source, "", documents == 0 ? "is empty" : "holds several YAML documents: allowed: one");
      return std::nullopt;
    }
    return converter.convert(YAML::Load(text), "", 0);
  }
  catch (const YAML::Exception& exception)
  {
    problems.add(converter.where(exception.mark), "", "not valid YAML: " + exception.msg);
    return std::nullopt;
  }
}

std::optional<std::string> readTextFile(const std::string& path, Problems& problems)
{
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() != std::filesystem::file_type::regular)
  {
    const bool there = std::filesystem::exists(status);
    problems.add(path, "", there ? "is not a regular file" : "cannot be read: " + error.message());
    return std::nullopt;
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > LARGEST_YAML)
  {
    problems.add(path, "", error ? "cannot be read: " + error.message() : "is larger than 1 MiB");
    return std::nullopt;
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (!stream || (size > 0 && !(text << stream.rdbuf())))
  {
    problems.add(path, "", std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : EIO));
    return std::nullopt;
  }
  return text.str();
}
}  // namespace drive
}  // namespace inverter_bus
