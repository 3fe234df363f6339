#pragma once

#include <QLineEdit>
#include <QPlainTextEdit>

namespace hermes::desktop {

/// Keys are text there.
inline bool isTyping(const QWidget *focus) {
    const auto *const text = qobject_cast<const QPlainTextEdit *>(focus);
    return qobject_cast<const QLineEdit *>(focus) || (text && !text->isReadOnly());
}

} // namespace hermes::desktop
