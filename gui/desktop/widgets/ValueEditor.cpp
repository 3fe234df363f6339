#include "gui/desktop/widgets/ValueEditor.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"

namespace hermes::desktop {

Faults::const_iterator faultAt(const Faults &faults, const QString &path) {
    const auto exact = faults.find(path);
    if (exact != faults.end())
        return exact;
    const auto below = faults.lower_bound(path + '.');
    return below != faults.end() && below->first.startsWith(path + '.') ? below : faults.end();
}

QString pathOf(const QString &parent, const QString &key) {
    return parent.isEmpty() ? key : parent + '.' + key;
}

void ValueEditor::showFaults(const QString &path, const Faults &faults) {
    if (focusProxy())
        theme::tint(*focusProxy(), QPalette::Text, theme::faultIf(faultAt(faults, path) != faults.end()));
}

void ValueEditor::hold(QWidget *input) {
    filled(this, inRow({input}));
    setFocusProxy(input);
}

void chainFocus(const QWidgetList &order) {
    for (int i = 1; i < order.size(); ++i)
        QWidget::setTabOrder(order[i - 1], order[i]);
}

} // namespace hermes::desktop
