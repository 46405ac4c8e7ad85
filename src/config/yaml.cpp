// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/yaml.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "config/scalar.h"
#include "config/text_file.h"
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
/// More than any file of this package; a few nested aliases can make billions of values.
constexpr std::size_t MOST_VALUES = 200000;

/// 0x21, 33 and '33' are the same key.
std::string canonical(const Scalar& key)
{
  const Scalar plain = key.quoted ? readScalar(key.text) : key;
  return plain.type == Value::Type::Integer ? std::to_string(plain.integer) : key.text;
}

std::string below(const std::string& path, const std::string& key)
{
  return path.empty() ? util::printable(key) : path + "." + util::printable(key);
}

class Reader
{
public:
  Reader(const std::string& source, Purpose purpose, Complaints& complaints)
    : source_(source), for_parameters_(purpose == Purpose::Parameters), complaints_(complaints)
  {
  }

  Value read(const YAML::Node& node, const std::string& path, const std::string& place, int depth)
  {
    Value result;
    result.place = place;
    if (depth > DEEPEST || ++values_ > MOST_VALUES)
    {
      giveUp(place, path, depth > DEEPEST ? "nested too deeply" : "too many values");
      return result;
    }
    switch (node.Type())
    {
      case YAML::NodeType::Scalar:
        result = readLeaf(node, path, place);
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
    if (for_parameters_ && !given_up_)
    {
      checkParameter(result, path);
    }
    return result;
  }

  std::string placeOfLine(int line) const
  {
    return line <= 0         ? source_
           : source_.empty() ? "line " + std::to_string(line)
                             : source_ + ":" + std::to_string(line);
  }

private:
  std::string placeOf(const YAML::Node& node) const
  {
    return placeOfLine(node.Mark().line + 1);
  }

  void add(const std::string& place, const std::string& path, const std::string& what)
  {
    complaints_.complain({ place, path }, what);
  }

  void giveUp(const std::string& place, const std::string& path, const std::string& what)
  {
    if (!given_up_)
    {
      add(place, path, what);
    }
    given_up_ = true;
  }

  void checkTag(const YAML::Node& node, const std::string& path, const std::string& allowed)
  {
    const std::string& tag = node.Tag();
    if (!tag.empty() && tag != "?" && tag != "!" && tag != allowed)
    {
      add(placeOf(node), path, "has the tag " + util::printable(tag) + ": allowed: no tag");
    }
  }

  Value readLeaf(const YAML::Node& node, const std::string& path, const std::string& place)
  {
    Scalar scalar = readScalar(node.Scalar(), node.Tag());
    scalar.place = place;
    if (!scalar.trap.empty())
    {
      add(place, path, "value '" + util::printable(scalar.text) + "' " + scalar.trap);
    }
    return scalar;
  }

  /// What the parameter server can't carry.
  void checkParameter(const Value& value, const std::string& path)
  {
    constexpr std::int64_t LOWEST = std::numeric_limits<std::int32_t>::min();
    constexpr std::int64_t HIGHEST = std::numeric_limits<std::int32_t>::max();
    if (value.type == Value::Type::None)
    {
      add(value.place, path,
          "has no value, and roslaunch can't load that: allowed: a value (# begins a comment: put a text that has one "
          "in "
          "quotes), or leave the key out");
    }
    if (value.type == Value::Type::Integer && (value.integer < LOWEST || value.integer > HIGHEST))
    {
      add(value.place, path,
          "value " + std::to_string(value.integer) +
              " has more than 32 bits, and roslaunch can't load that: allowed: " + std::to_string(LOWEST) + " to " +
              std::to_string(HIGHEST) + "; a bit mask with station 31 in quotes, '0x80000002'");
    }
  }

  void readList(const YAML::Node& node, const std::string& path, int depth, Value& result)
  {
    result.type = Value::Type::List;
    for (std::size_t i = 0; i < node.size() && !given_up_; ++i)
    {
      result.list.push_back(read(node[i], path + "[" + std::to_string(i) + "]", placeOf(node[i]), depth + 1));
    }
  }

  void readMap(const YAML::Node& node, const std::string& path, int depth, Value& result)
  {
    result.type = Value::Type::Map;
    std::set<std::string> seen;
    std::vector<Entry> merged;
    for (auto pair = node.begin(); pair != node.end() && !given_up_; ++pair)
    {
      const std::string place = placeOf(pair->first);
      const std::optional<Scalar> key = readKey(pair->first, path);
      if (!key)
      {
        continue;
      }
      const std::string entry_path = below(path, key->text);
      if (!seen.insert(canonical(*key)).second)
      {
        add(place, entry_path, "duplicate key: allowed once");
        continue;
      }
      // A map or an empty value is on the line after its key for yaml-cpp; people look for the key.
      Entry entry{ key->text, read(pair->second, entry_path, place, depth + 1) };
      if (!key->quoted && key->text == "<<")
      {
        collectMerged(entry.value, path, merged);
        continue;
      }
      result.map.push_back(std::move(entry));
    }
    merge(merged, seen, result);
    if (for_parameters_)
    {
      std::sort(result.map.begin(), result.map.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
    }
  }

  std::optional<Scalar> readKey(const YAML::Node& node, const std::string& path)
  {
    if (!node.IsScalar())
    {
      add(placeOf(node), path, "a key must be a plain word or number: allowed: key: value");
      return std::nullopt;
    }
    Scalar key = readScalar(node.Scalar(), node.Tag());
    const std::string shown = util::printable(key.text);
    const bool merges = key.text == "<<" || key.text == "=";
    if (!key.trap.empty() && !merges)
    {
      add(placeOf(node), below(path, key.text), "the key '" + shown + "' " + key.trap);
    }
    if (for_parameters_ && key.type != Value::Type::Text)
    {
      add(placeOf(node), below(path, key.text),
          "the key '" + shown + "' is not a text, and roslaunch can load no others: allowed: '" + shown +
              "' in quotes");
    }
    return key;
  }

  /// The maps behind `<<`: the first ones win.
  void collectMerged(const Value& value, const std::string& path, std::vector<Entry>& merged)
  {
    const std::vector<Value> one{ value };
    for (const Value& map : value.type == Value::Type::List ? value.list : one)
    {
      if (map.type != Value::Type::Map)
      {
        add(value.place, below(path, "<<"),
            "merges something other than a map: allowed: *NAME of a map, or a list of them");
        return;
      }
      merged.insert(merged.end(), map.map.begin(), map.map.end());
    }
  }

  /// The map's own keys go before those that are merged into it, wherever they are.
  static void merge(std::vector<Entry>& merged, std::set<std::string>& seen, Value& result)
  {
    for (Entry& entry : merged)
    {
      if (seen.insert(canonical(readScalar(entry.key))).second)
      {
        result.map.push_back(std::move(entry));
      }
    }
  }

  const std::string source_;
  const bool for_parameters_;
  Complaints& complaints_;
  std::size_t values_ = 0;
  bool given_up_ = false;
};
}  // namespace

std::optional<Value> readYaml(const std::string& text, const std::string& source, Purpose purpose,
                              Complaints& complaints)
{
  Reader reader(source, purpose, complaints);
  std::optional<TextProblem> problem = problemOfText(text);
  try
  {
    const int documents = problem ? 1 : countDocuments(text);
    if (documents != 1)
    {
      problem = TextProblem{ 0, documents == 0 ? "is empty: allowed: one YAML document"
                                               : "holds several YAML documents: allowed: one" };
    }
    if (!problem)
    {
      const YAML::Node root = YAML::Load(text);
      return reader.read(root, "", reader.placeOfLine(root.Mark().line + 1), 0);
    }
  }
  catch (const YAML::Exception& exception)
  {
    problem = TextProblem{ exception.mark.line + 1, "not valid YAML: " + exception.msg };
  }
  complaints.complain({ reader.placeOfLine(problem->line), "" }, problem->what);
  return std::nullopt;
}

std::optional<Value> readYamlFile(const std::string& path, Purpose purpose, Complaints& complaints)
{
  std::string error;
  const auto text = readTextFile(path, error);
  if (!text)
  {
    complaints.complain({ path, "" }, error);
    return std::nullopt;
  }
  return readYaml(*text, path, purpose, complaints);
}
}  // namespace config
}  // namespace inverter_bus
