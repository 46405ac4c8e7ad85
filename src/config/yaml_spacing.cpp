// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/yaml_spacing.h"

#include <algorithm>
#include <cstddef>

namespace inverter_bus
{
namespace config
{
namespace
{
/// Walks over a text and knows what a character belongs to.
class Walk
{
public:
  explicit Walk(const std::string& yaml) : yaml_(yaml)
  {
  }

  SpacingMistakes find()
  {
    SpacingMistakes mistakes;
    while (at_ < yaml_.size() && open_quote_ == 0)
    {
      if (line_start_)
      {
        beginLine();
        continue;
      }
      if (yaml_[at_] == '\t')
      {
        mistakes.tab = line_;
        break;
      }
      step();
    }
    mistakes.open_quote = open_quote_;
    return mistakes;
  }

private:
  void beginLine()
  {
    const std::size_t first = std::min(yaml_.find_first_not_of(' ', at_), yaml_.size());
    // A line further right than the key goes on with the unquoted text of the line before it.
    const bool goes_on = in_word_ && flow_ == 0 && first - at_ > column_;
    column_ = goes_on ? column_ : first - at_;
    at_ = first;
    line_start_ = false;
    word_start_ = !goes_on;
  }

  void step()
  {
    const char c = yaml_[at_];
    const bool after_blank = at_ == 0 || yaml_[at_ - 1] == ' ' || yaml_[at_ - 1] == '\n';
    if (c == '\n')
    {
      endLine();
    }
    else if (c == '#' && after_blank)
    {
      in_word_ = false;
      word_start_ = true;
      skipTo('\n');
    }
    else if (word_start_ && (c == '"' || c == '\''))
    {
      skipQuotes(c);
    }
    else if (word_start_ && flow_ == 0 && (c == '|' || c == '>'))
    {
      skipBlock();
    }
    else
    {
      move(c);
    }
  }

  /// One character of a word, or between words.
  void move(char c)
  {
    const bool last =
        at_ + 1 >= yaml_.size() || yaml_[at_ + 1] == ' ' || yaml_[at_ + 1] == '\n' || yaml_[at_ + 1] == '\r';
    const bool opens = c == '[' || c == '{';
    if (word_start_ && (c == '&' || c == '!' || c == '*'))
    {
      // An anchor or a tag: the word comes after it.
      at_ = std::min(yaml_.find_first_of(" \n\t,]}", at_), yaml_.size());
      return;
    }
    if (opens && (word_start_ || flow_ > 0))
    {
      ++flow_;
      word_start_ = true;
    }
    else if (flow_ > 0 && (c == ']' || c == '}' || c == ','))
    {
      flow_ -= c == ',' ? 0 : 1;
      word_start_ = c == ',';
    }
    else if ((c == ':' && (last || flow_ > 0)) || ((c == '-' || c == '?') && word_start_ && last))
    {
      column_ += c == ':' ? 0 : 2;
      word_start_ = true;
    }
    else if (c != ' ' && c != '\r')
    {
      word_start_ = false;
      in_word_ = true;
    }
    in_word_ = in_word_ && !word_start_;
    ++at_;
  }

  void endLine()
  {
    ++line_;
    ++at_;
    line_start_ = true;
  }

  void skipTo(char end)
  {
    at_ = std::min(yaml_.find(end, at_), yaml_.size());
  }

  void skipQuotes(char quote)
  {
    const int opened = line_;
    for (++at_; at_ < yaml_.size() && yaml_[at_] != quote; ++at_)
    {
      line_ += yaml_[at_] == '\n' ? 1 : 0;
      if (quote == '"' && yaml_[at_] == '\\' && at_ + 1 < yaml_.size())
      {
        ++at_;
        line_ += yaml_[at_] == '\n' ? 1 : 0;
      }
    }
    open_quote_ = at_ < yaml_.size() ? 0 : opened;
    at_ = std::min(at_ + 1, yaml_.size());
    // '' in single quotes opens them once more.
    word_start_ = quote == '\'' && at_ < yaml_.size() && yaml_[at_] == quote;
    in_word_ = false;
  }

  /// Lines that are empty or further right than the key of the block.
  void skipBlock()
  {
    in_word_ = false;
    skipTo('\n');
    while (at_ < yaml_.size())
    {
      const std::size_t start = at_ + 1;
      const std::size_t first = std::min(yaml_.find_first_not_of(' ', start), yaml_.size());
      if (first < yaml_.size() && yaml_[first] != '\n' && first - start <= column_)
      {
        break;
      }
      ++line_;
      at_ = std::min(yaml_.find('\n', first), yaml_.size());
    }
  }

  const std::string& yaml_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool line_start_ = true;
  /// A word may begin here.
  bool word_start_ = true;
  /// Behind an unquoted text, which may continue on the next line.
  bool in_word_ = false;
  /// Of the key that a block of text would belong to.
  std::size_t column_ = 0;
  unsigned flow_ = 0;
  int open_quote_ = 0;
};
}  // namespace

SpacingMistakes findSpacingMistakes(const std::string& yaml)
{
  return Walk(yaml).find();
}
}  // namespace config
}  // namespace inverter_bus
