// What clang reads once for all that is fuzzed.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <variant>

#include "../support/clang_pch.hpp"
