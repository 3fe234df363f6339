#pragma once

#include "gui/desktop/widgets/PlainLabel.h"

namespace hermes::desktop {

/// Where a panel tells how something ended, beside what caused it; hidden until there is something to tell.
class MessageLabel : public PlainLabel {
    Q_OBJECT
public:
    explicit MessageLabel(QWidget *parent = nullptr);

public Q_SLOTS:
    void tell(const QString &text, bool isError = false);
};

} // namespace hermes::desktop
