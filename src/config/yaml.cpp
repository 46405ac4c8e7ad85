// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/yaml.h"

#include <algorithm>
#include <set>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "config/yaml_text.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace config
{
namespace
{
/// Deeper than any file of this package; an alias that contains itself would have no bottom.
constexpr int DEEPEST = 20;
/// More than any file of this package; a few nested aliases can stand for billions of values.
constexpr std::size_t MOST_VALUES = 200000;

/// 0x21, 33 and '33' are the same key.
std::string canonical(const Scalar& key)
{
  const Scalar plain = key.quoted ? readScalar(key.text) : key;
  return plain.type == Scalar::Type::Integer ? std::to_string(plain.integer) : key.text;
}

std::string below(const std::string& path, const std::string& key)
{
  return path.empty() ? util::printable(key) : path + "." + util::printable(key);
}

class Reader
{
public:
  explicit Reader(std::vector<YamlProblem>& problems) : problems_(problems)
  {
  }

  YamlNode read(const YAML::Node& node, const std::string& path, int depth)
  {
    YamlNode result;
    result.line = lineOf(node);
    if (depth > DEEPEST || ++values_ > MOST_VALUES)
    {
      giveUp(result.line, path, depth > DEEPEST ? "nested too deeply" : "too many values");
      return result;
    }
    switch (node.Type())
    {
      case YAML::NodeType::Scalar:
        readLeaf(node, path, result);
        break;
      case YAML::NodeType::Sequence:
        checkTag(node, path, "tag:yaml.org,2002:seq");
        readList(node, path, depth, result);
        break;
      case YAML::NodeType::Map:
        checkTag(node, path, "tag:yaml.org,2002:map");
        readMap(node, path, depth, result);
        break;
      default:
        break;
    }
    return result;
  }

private:
  static int lineOf(const YAML::Node& node)
  {
    return node.Mark().line + 1;
  }

  void add(int line, const std::string& path, const std::string& what)
  {
    problems_.push_back({ line, path, what });
  }

  void giveUp(int line, const std::string& path, const std::string& what)
  {
    if (!given_up_)
    {
      add(line, path, what);
    }
    given_up_ = true;
  }

  void checkTag(const YAML::Node& node, const std::string& path, const std::string& allowed)
  {
    const std::string& tag = node.Tag();
    if (!tag.empty() && tag != "?" && tag != "!" && tag != allowed)
    {
      add(lineOf(node), path, "has the tag " + util::printable(tag) + ": allowed: no tag");
    }
  }

  void readLeaf(const YAML::Node& node, const std::string& path, YamlNode& result)
  {
    result.scalar = readScalar(node.Scalar(), node.Tag());
    if (!result.scalar.trap.empty())
    {
      add(result.line, path, "value '" + util::printable(result.scalar.text) + "' " + result.scalar.trap);
    }
  }

  void readList(const YAML::Node& node, const std::string& path, int depth, YamlNode& result)
  {
    result.kind = YamlNode::Kind::List;
    for (std::size_t i = 0; i < node.size() && !given_up_; ++i)
    {
      result.items.push_back(read(node[i], path + "[" + std::to_string(i) + "]", depth + 1));
    }
  }

  void readMap(const YAML::Node& node, const std::string& path, int depth, YamlNode& result)
  {
    result.kind = YamlNode::Kind::Map;
    std::set<std::string> seen;
    std::vector<YamlEntry> merged;
    for (auto pair = node.begin(); pair != node.end() && !given_up_; ++pair)
    {
      YamlEntry entry;
      if (!readKey(pair->first, path, entry))
      {
        continue;
      }
      const std::string entry_path = below(path, entry.key.text);
      if (!seen.insert(canonical(entry.key)).second)
      {
        add(entry.line, entry_path, "duplicate key: allowed once");
        continue;
      }
      entry.value = read(pair->second, entry_path, depth + 1);
      if (!entry.key.quoted && entry.key.text == "<<")
      {
        collectMerged(entry, path, merged);
        continue;
      }
      // A map or an empty value "stands" on the line after its key for yaml-cpp; people look for the key.
      entry.value.line = entry.line;
      result.entries.push_back(std::move(entry));
    }
    merge(merged, seen, result);
  }

  bool readKey(const YAML::Node& node, const std::string& path, YamlEntry& entry)
  {
    entry.line = lineOf(node);
    if (!node.IsScalar())
    {
      add(entry.line, path, "a key must be a plain word or number: allowed: key: value");
      return false;
    }
    entry.key = readScalar(node.Scalar(), node.Tag());
    const bool merges = entry.key.text == "<<" || entry.key.text == "=";
    if (!entry.key.trap.empty() && !merges)
    {
      add(entry.line, below(path, entry.key.text),
          "the key '" + util::printable(entry.key.text) + "' " + entry.key.trap);
    }
    return true;
  }

  /// The maps behind `<<`: those that stand first win.
  void collectMerged(const YamlEntry& entry, const std::string& path, std::vector<YamlEntry>& merged)
  {
    const YamlNode& value = entry.value;
    const bool several = value.kind == YamlNode::Kind::List;
    const std::vector<YamlNode> one{ value };
    for (const YamlNode& map : several ? value.items : one)
    {
      if (map.kind != YamlNode::Kind::Map)
      {
        add(entry.line, below(path, "<<"),
            "merges something else than a map: allowed: *NAME of a map, or a list of those");
        return;
      }
      merged.insert(merged.end(), map.entries.begin(), map.entries.end());
    }
  }

  /// The map's own keys go before those that are merged into it, wherever they stand.
  static void merge(std::vector<YamlEntry>& merged, std::set<std::string>& seen, YamlNode& result)
  {
    for (YamlEntry& entry : merged)
    {
      if (seen.insert(canonical(entry.key)).second)
      {
        result.entries.push_back(std::move(entry));
      }
    }
  }

  std::vector<YamlProblem>& problems_;
  std::size_t values_ = 0;
  bool given_up_ = false;
};
}  // namespace

std::optional<YamlNode> readYaml(const std::string& text, std::vector<YamlProblem>& problems)
{
  if (const auto problem = problemOfText(text))
  {
    problems.push_back(*problem);
    return std::nullopt;
  }
  try
  {
    const int documents = countDocuments(text);
    if (documents != 1)
    {
      problems.push_back(
          { 0, "",
            documents == 0 ? "is empty: allowed: one YAML document" : "holds several YAML documents: allowed: one" });
      return std::nullopt;
    }
    return Reader(problems).read(YAML::Load(text), "", 0);
  }
  catch (const YAML::Exception& exception)
  {
    problems.push_back({ exception.mark.line + 1, "", "not valid YAML: " + exception.msg });
    return std::nullopt;
  }
}
}  // namespace config
}  // namespace inverter_bus
