#include "gui/desktop/widgets/ValueEditor.h"

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

void ValueEditor::addFaults(const QString &, Faults &) const {}

bool ValueEditor::placeNote(QWidget *) {
    return false;
}

void chainFocus(const QWidgetList &order) {
    for (int i = 1; i < order.size(); ++i)
        QWidget::setTabOrder(order[i - 1], order[i]);
}

} // namespace hermes::desktop
