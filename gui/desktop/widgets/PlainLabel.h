#pragma once

#include "gui/desktop/widgets/ForeignText.h"

#include <QLabel>

namespace hermes::desktop {

/// A label for text that may be foreign: plain, and not longer than somebody reads.
class PlainLabel : public QLabel {
    Q_OBJECT
public:
    explicit PlainLabel(const QString &text = {}, QWidget *parent = nullptr)
        : QLabel(parent) {
        setTextFormat(Qt::PlainText);
        setText(text);
    }
    void setText(const QString &text) { QLabel::setText(shortText(text)); }
    void setBold(bool isBold) {
        QFont changed = font();
        changed.setBold(isBold);
        setFont(changed);
    }
};

} // namespace hermes::desktop
