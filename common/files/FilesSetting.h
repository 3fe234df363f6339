#pragma once

#include "common/schema/Field.h"
#include "common/settings/Settings.h"

#include <QStringList>

namespace hermes {

/// The setting `files.folders`: below which clients may name files to be read.
Field namedFilesField();
QStringList namedFilesFolders(const Settings &settings);

} // namespace hermes
