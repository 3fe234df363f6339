#include "gui/vector/InstalledWorlds.h"

#include "gui/vector/Failure.h"

#include <set>

namespace hermes::vector {

namespace fs = std::filesystem;

std::string worldFile(const std::string &nameOrPath) {
    const fs::path path = fs::u8path(nameOrPath);
    std::error_code error;
    if (nameOrPath == "-" || path.has_parent_path() || fs::exists(path, error))
        return nameOrPath;
    const fs::path installed = installedWorlds() / fs::u8path(nameOrPath + ".json");
    if (fs::exists(installed, error))
        return installed.u8string();
    std::set<std::string> names;
    for (fs::directory_iterator file(installedWorlds(), error), end; !error && file != end;
         file.increment(error))
        if (file->path().extension() == ".json")
            names.insert(file->path().stem().u8string());
    std::string list;
    for (const std::string &name : names)
        list += (list.empty() ? "" : ", ") + name;
    throw Failure(nameOrPath + ": found no such file, expected one, or the name of a world: " + list);
}

} // namespace hermes::vector
