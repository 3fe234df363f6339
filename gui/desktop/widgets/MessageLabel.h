#pragma once

#include "gui/desktop/widgets/PlainLabel.h"

namespace hermes::desktop {

/// Where a panel tells how something ended; hidden until there is something to tell. Its place is kept
/// while it is hidden: what is clicked at does not move under the mouse.
class MessageLabel : public PlainLabel {
    Q_OBJECT
public:
    explicit MessageLabel(QWidget *parent = nullptr);

public Q_SLOTS:
    void tell(const QString &text, bool isError = false);
};

} // namespace hermes::desktop
