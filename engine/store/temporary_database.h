#pragma once

#include <string>

#include "engine/store/database.h"

namespace patina {

/// A database in a temporary file without a name. It lies in the folder that TMPDIR names, else in /var/tmp, and goes
/// with the process, however that ends; nothing in it survives that. `prefix`: of the name in messages. Throws Error
/// where the file cannot be created.
Database temporary_database(const std::string& prefix);

}  // namespace patina
