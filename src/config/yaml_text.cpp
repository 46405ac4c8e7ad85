// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/yaml_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "config/yaml.h"
#include "config/yaml_spacing.h"
#include "util/utf8.h"

namespace inverter_bus
{
namespace config
{
namespace
{
/// Deeper than any file of this package; a parser that recurses must not be fed more than its stack holds.
constexpr unsigned DEEPEST = 100;

class Measure : public YAML::EventHandler
{
public:
  void OnDocumentStart(const YAML::Mark& /*mark*/) override
  {
  }
  void OnDocumentEnd() override
  {
  }
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override
  {
  }
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override
  {
  }
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override
  {
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override
  {
    descend(mark);
  }
  void OnSequenceEnd() override
  {
    --depth_;
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override
  {
    descend(mark);
  }
  void OnMapEnd() override
  {
    --depth_;
  }

private:
  void descend(const YAML::Mark& mark)
  {
    if (++depth_ > DEEPEST)
    {
      throw YAML::ParserException(mark, "nested too deeply");
    }
  }

  unsigned depth_ = 0;
};

/// How deep flow collections, blocks and lists are nested at most, without parsing.
unsigned depthOf(const std::string& yaml)
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

/// Characters that YAML 1.1 allows in a text (5.1 of its specification).
bool isPrintable(std::uint32_t character)
{
  return character == 0x09 || character == 0x0A || character == 0x0D || character == 0x85 ||
         (character >= 0x20 && character <= 0x7E) || (character >= 0xA0 && character <= 0xD7FF) ||
         (character >= 0xE000 && character <= 0xFFFD) || (character >= 0x10000 && character <= 0x10FFFF);
}

/// The line of the first character that no YAML text may hold; 0: there is none.
int lineOfUnprintable(const std::string& yaml)
{
  int line = 1;
  for (std::size_t at = 0; at < yaml.size();)
  {
    const util::Character character = util::characterAt(yaml, at);
    if (character.length == 0 || !isPrintable(character.code))
    {
      return line;
    }
    line += character.code == '\n' ? 1 : 0;
    at += character.length;
  }
  return 0;
}
}  // namespace

std::optional<TextProblem> problemOfText(const std::string& yaml)
{
  if (yaml.size() > LARGEST_YAML)
  {
    return TextProblem{ 0, "is larger than 1 MiB" };
  }
  if (depthOf(yaml) > DEEPEST)
  {
    return TextProblem{ 0, "nested too deeply" };
  }
  if (const int line = lineOfUnprintable(yaml))
  {
    return TextProblem{ line, "not valid YAML: a control character, or bytes that are not UTF-8" };
  }
  const SpacingMistakes spacing = findSpacingMistakes(yaml);
  if (spacing.tab > 0)
  {
    return TextProblem{ spacing.tab, "not valid YAML: a tab between words: allowed: spaces" };
  }
  if (spacing.open_quote > 0)
  {
    return TextProblem{ spacing.open_quote, "not valid YAML: the quotes that are opened here are never closed" };
  }
  return std::nullopt;
}

int countDocuments(const std::string& yaml)
{
  constexpr int SEVERAL = 2;
  std::istringstream stream(yaml);
  YAML::Parser parser(stream);
  Measure measure;
  int documents = 0;
  while (documents < SEVERAL && parser.HandleNextDocument(measure))
  {
    ++documents;
  }
  return documents;
}
}  // namespace config
}  // namespace inverter_bus
