// What is plotted where, as it is kept from run to run.
#include "gui/desktop/panels/PlotBoard.h"
#include "gui/desktop/view/PlotPane.h"

#include <QJsonArray>

namespace hermes::desktop {

QJsonObject PlotBoard::state() const {
    QJsonArray panes;
    for (const Pane &pane : panes_) {
        QJsonArray curves;
        for (const Curve &curve : pane.curves) {
            QJsonObject one{
                {"daemon", curve.field.address}, {"topic", curve.field.topic}, {"field", curve.field.path}};
            if (curve.isRight)
                one["right"] = *curve.isRight;
            curves.append(one);
        }
        panes.append(curves);
    }
    return {{"span_s", time_.span_s()}, {"panes", panes}};
}

void PlotBoard::clear() {
    while (panes_.size() > 1) {
        chosen_ = 0;
        removePane();
    }
    removePane();
}

void PlotBoard::setState(const QJsonObject &state) {
    clear();
    const QJsonArray panes = state["panes"].toArray();
    for (int i = 0; i < std::min(panes.size(), maxPanes); ++i) {
        Pane &pane = i == 0 ? panes_.front() : newPane();
        for (const QJsonValue &one : panes[i].toArray()) {
            const FieldId field{one["daemon"].toString(), one["topic"].toString(), one["field"].toString()};
            const QJsonValue right = one["right"];
            if (!field.topic.isEmpty() && curves() < maxCurves && !has(field))
                insert(pane, field, right.isBool() ? std::make_optional(right.toBool()) : std::nullopt);
        }
    }
    time_.setSpan(state["span_s"].toDouble(TimeWindow::usual_s));
    goLive();
    Q_EMIT changed();
}

} // namespace hermes::desktop
