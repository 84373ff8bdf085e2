// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace aims {

/// A script that lets bash complete the commands of `program`, their options and the values of
/// these. What it knows comes from the declarations; names of scenarios and estimators it asks the
/// program for (`aims completion scenarios`).
std::string bash_completion(const CLI::App& program);

/// The same for zsh, the text of a file `_aims` in a folder of `fpath`.
std::string zsh_completion(const CLI::App& program);

}  // namespace aims
