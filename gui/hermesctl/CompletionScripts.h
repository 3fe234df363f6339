#pragma once

#include <QStringList>

namespace hermes::ctl {

/// The shells that there is a script for.
QStringList completionShells();

/// For a shell to read: the files of deploy/completion. "" for one that is not known.
QString completionScript(const QString &shell);

} // namespace hermes::ctl
