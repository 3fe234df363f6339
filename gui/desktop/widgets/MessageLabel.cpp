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
}

void MessageLabel::tell(const QString &text, bool isError) {
    QPalette palette;
    if (isError)
        palette.setColor(QPalette::WindowText, theme::colour(Condition::Fault));
    setPalette(palette);
    setText(inPlainWords(text));
    show();
}

} // namespace hermes::desktop
