// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_TEXT_FILE_H
#define INVERTER_BUS_FUZZ_TEXT_FILE_H

#include <cstddef>
#include <cstdint>
#include <string>

namespace inverter_bus
{
namespace fuzz
{
/// A file in memory for functions that want a path.
class TextFile
{
public:
  TextFile();
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  void write(const std::uint8_t* data, std::size_t size);
  const std::string& path() const;

private:
  int descriptor_;
  std::string path_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_TEXT_FILE_H
