// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "yaml_measure.h"

#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
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
    if (++depth_ > DEEPEST_YAML)
    {
      throw YAML::ParserException(mark, "nested too deeply");
    }
  }

  unsigned depth_ = 0;
};
}  // namespace

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
}  // namespace drive
}  // namespace inverter_bus
