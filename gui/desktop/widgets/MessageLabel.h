#pragma once

#include "gui/desktop/widgets/PlainLabel.h"

#include <QTimer>

namespace hermes::desktop {

/// Where a panel tells how something ended; hidden until there is something to tell. Its place is kept
/// while it is hidden: what is clicked at does not move under the mouse. A minute later it is grey, and
/// begins with the time at which it was told.
class MessageLabel : public PlainLabel {
    Q_OBJECT
public:
    explicit MessageLabel(QWidget *parent = nullptr);

public Q_SLOTS:
    /// isState: it tells how something is, and who tells it ends it.
    void tell(const QString &text, bool isError = false, bool isState = false);

private:
    QTimer old_{this};
};

} // namespace hermes::desktop
