// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "config/yaml.h"
#include "drive/profile/profile_builder.h"
#include "drive/profile/profile_overrides.h"
#include "drive/profile/profile_skip.h"
#include "inverter_bus/drive/profile.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr const char* EXTENSION = ".yaml";

/// The file of a profile; a problem that lists the known names if there is none.
std::string profilePath(const std::string& name_or_path, const std::string& directory, const std::string& place,
                        Problems& problems)
{
  if (!name_or_path.empty() && name_or_path[0] == '/')
  {
    return name_or_path;
  }
  const std::vector<std::string> known = knownProfiles(directory);
  if (std::find(known.begin(), known.end(), name_or_path) != known.end())
  {
    return (std::filesystem::path(directory) / (name_or_path + EXTENSION)).string();
  }
  problems.complain({ place.empty() ? directory : place, "drive" },
                    "value '" + util::printable(name_or_path) + "': allowed: an absolute path, or one of: " +
                        (known.empty() ? "(no profiles in " + directory + ")" : util::joined(known)));
  return "";
}

void applyOverrides(Value& root, Value overrides, Problems& problems)
{
  if (overrides.type == Value::Type::None)
  {
    return;
  }
  if (overrides.type != Value::Type::Map)
  {
    problems.complain({ overrides.place, "overrides" }, "allowed: a map of profile keys");
    return;
  }
  nameConstants(root, overrides);
  mergeOverrides(root, overrides);
}

/// A constant may be confirmed by its own name, whatever its mark is called.
std::vector<std::string> markNames(const std::vector<std::string>& names, const std::set<std::string>& known,
                                   const std::map<std::string, std::string>& constants)
{
  std::vector<std::string> marks;
  for (const std::string& name : names)
  {
    const auto constant = constants.find(name);
    const bool alias = known.count(name) == 0 && constant != constants.end();
    marks.push_back(alias ? constant->second : name);
  }
  return marks;
}

Profile readProfile(const std::string& path, const ProfileChanges& changes, Problems& problems)
{
  auto root = config::readYamlFile(path, config::Purpose::Profile, problems);
  if (!root)
  {
    return Profile();
  }
  const std::set<std::string> known = unconfirmedNames(*root);
  const std::map<std::string, std::string> constants = constantMarks(*root);
  applyOverrides(*root, changes.overrides, problems);
  const std::string& place = changes.confirm_place.empty() ? changes.place : changes.confirm_place;
  confirm(*root, markNames(changes.confirm, known, constants), known, place.empty() ? path : place, problems);
  skipFields(*root, changes.skip);
  Profile profile = buildProfile(*root, problems);
  profile.file = path;
  return profile;
}
}  // namespace

std::vector<std::string> knownProfiles(const std::string& directory)
{
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
  {
    const std::filesystem::path& path = entry->path();
    if (path.extension() == EXTENSION)
    {
      names.push_back(path.stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

Profile loadProfile(const std::string& name_or_path, const std::string& directory, const ProfileChanges& changes)
{
  Problems problems;
  const std::string path = profilePath(name_or_path, directory, changes.place, problems);
  Profile profile = problems.empty() ? readProfile(path, changes, problems) : Profile();
  if (!problems.empty())
  {
    throw ConfigurationError(problems.lines().front());
  }
  return profile;
}

std::vector<std::string> checkProfile(const std::string& path)
{
  Problems problems;
  const Profile profile = readProfile(path, ProfileChanges(), problems);
  std::vector<std::string> lines = problems.lines();
  lines.insert(lines.end(), profile.mistakes.begin(), profile.mistakes.end());
  return lines;
}
}  // namespace drive
}  // namespace inverter_bus
