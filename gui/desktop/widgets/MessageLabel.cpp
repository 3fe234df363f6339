#include "gui/desktop/widgets/MessageLabel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"

namespace hermes::desktop {

MessageLabel::MessageLabel(QWidget *parent)
    : PlainLabel(QString(), parent) {
    setObjectName("message");
    setWordWrap(true);
    setMinimumSize(1, fontMetrics().lineSpacing()); // a word without end widens no panel
    QSizePolicy policy = sizePolicy();
    policy.setRetainSizeWhenHidden(true);
    setSizePolicy(policy);
    hide();
    old_.setSingleShot(true);
    old_.setInterval(std::chrono::minutes(1));
}

void MessageLabel::tell(const QString &text, bool isError, bool isState) {
    theme::tint(*this, QPalette::WindowText, theme::faultIf(isError));
    setText(inPlainWords(text));
    setEnabled(true);
    show();
    old_.disconnect();
    isState || text.isEmpty() ? old_.stop() : old_.start();
    connect(&old_, &QTimer::timeout, this, [this, time = QTime::currentTime()] {
        setText(time.toString("HH:mm:ss  ") + this->text());
        setEnabled(false);
    });
}

} // namespace hermes::desktop
