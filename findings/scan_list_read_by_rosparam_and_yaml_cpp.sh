#!/usr/bin/env bash
# rosparam and yaml-cpp make different settings of the same scan list, and neither says a word.
#
# Peers: python3-rosparam 1.15.15+ds-2 (roslaunch loads with it) and libyaml-cpp0.7 0.7.0+dfsg-8+b1 (Debian 12).
# Guess: a node that gets its scan list from roslaunch and a C++ tool that reads the file itself, a simulator or a
# checker, see the same values.
# Seen: the table below. One is YAML 1.1 (1:30 is 90, 1e2 is text), the other one converts what the C++ type asks for;
# one merges "<<", the other one has a key of that name; of a key that is there twice one takes the last, the other the
# first.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(python3-rosparam=1.15.15+ds-2 libyaml-cpp-dev=0.7.0+dfsg-8+b1 libyaml-cpp0.7=0.7.0+dfsg-8+b1)
mkdir -p debs/partial
apt-get -o "Dir::Cache::archives=$work/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root -qq -y --reinstall \
  --allow-downgrades --no-install-recommends --download-only install "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in debs/*.deb; do dpkg -x "$package" root; done

cat >scan_list.yaml <<'YAML'
belt: &belt {parity: even}
entry:
  <<: *belt
  node: 1:30
  hz_per_unit: 1e2
  max_velocity: 010
  stop_bits: 1
  stop_bits: 2
YAML
cat >read.cpp <<'CPP'
#include <iostream>
#include <yaml-cpp/yaml.h>
template <typename T>
void show(const char* key, const YAML::Node& value)
{
  try
  {
    std::cout << key << ": ";
    std::cout << value.as<T>() << '\n';
  }
  catch (const YAML::Exception&)
  {
    std::cout << (value ? "no number" : "missing") << '\n';
  }
}
int main()
{
  const YAML::Node entry = YAML::LoadFile("scan_list.yaml")["entry"];
  show<std::string>("parity", entry["parity"]);
  show<int>("node", entry["node"]);
  show<double>("hz_per_unit", entry["hz_per_unit"]);
  show<double>("max_velocity", entry["max_velocity"]);
  show<int>("stop_bits", entry["stop_bits"]);
}
CPP
libraries=$(dirname "$(find "$work/root" -name libyaml-cpp.so.0.7)")
g++ -std=c++17 -isystem root/usr/include read.cpp -o read -L"$libraries" -lyaml-cpp

PYTHONPATH=$work/root/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 - <<'PYTHON' | tee seen
import subprocess

import rosparam

(by_rosparam, _), = rosparam.load_file('scan_list.yaml')
by_yaml_cpp = subprocess.run(['./read'], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
for line in by_yaml_cpp.splitlines():
    key, value = line.split(': ')
    print('%-13s rosparam %-6r yaml-cpp %s' % (key + ':', by_rosparam['entry'][key], value))
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
parity:       rosparam 'even' yaml-cpp missing
node:         rosparam 90     yaml-cpp no number
hz_per_unit:  rosparam '1e2'  yaml-cpp 100
max_velocity: rosparam 8      yaml-cpp 10
stop_bits:    rosparam 2      yaml-cpp 1
SEEN
echo "as seen"
