#pragma once

#include "gui/desktop/widgets/OneDialog.h"

#include <functional>

namespace hermes::desktop {

/// Asks for a file to write, and once more where it exists; name: proposed. No question of it is modal.
void askForFile(OneDialog &questions, QWidget *parent, const QString &title, const QString &name,
                const QString &kinds, const std::function<void(const QString &file)> &use);

} // namespace hermes::desktop
