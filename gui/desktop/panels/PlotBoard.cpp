#include "gui/desktop/panels/PlotBoard.h"

#include "gui/desktop/view/PlotPane.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QMenu>

namespace hermes::desktop {

PlotBoard::PlotBoard(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , sampler_(fleet)
    , layout_(inColumn({})) {
    filled(this, layout_, 1);
    newPane();
    connect(&time_, &TimeWindow::changed, this, [this] {
        if (!time_.isHeld())
            heldNow_.clear();
        showCurves();
    });
    connect(&time_, &TimeWindow::cursorMoved, this, [this] {
        for (const Pane &pane : panes_)
            pane.widget->scene().cursorTime = cursorTime();
    });
}

std::vector<PlotPane *> PlotBoard::panes() const {
    std::vector<PlotPane *> all;
    for (const Pane &pane : panes_)
        all.push_back(pane.widget);
    return all;
}

PlotBoard::Pane &PlotBoard::newPane() {
    auto *const widget = new PlotPane(time_);
    layout_->addWidget(widget, 1);
    panes_.push_back({widget, {}});
    connect(widget, &PlotPane::chosen, this, [this, widget] {
        for (std::size_t i = 0; i < panes_.size(); ++i)
            if (panes_[i].widget == widget)
                choosePane(int(i));
    });
    connect(widget, &PlotPane::liveWanted, this, &PlotBoard::goLive);
    connect(widget, &PlotPane::menuWanted, this,
            [this, widget](const QPoint &place) { openMenu(*widget, place); });
    return panes_.back();
}

/// Of one chart: its curves, their axes, and the charts.
void PlotBoard::openMenu(const PlotPane &pane, const QPoint &place) {
    auto *const menu = new QMenu(this);
    menu->setAttribute(Qt::WA_DeleteOnClose);
    menu->addAction(tr("Live"), this, &PlotBoard::goLive);
    auto *const axes = menu->addMenu(tr("Axis on the right"));
    auto *const remove = menu->addMenu(tr("Remove a curve"));
    for (const PlotLine &line : pane.scene().lines) {
        QAction *const right = axes->addAction(labelText(line.name));
        right->setCheckable(true);
        right->setChecked(line.isRight);
        connect(right, &QAction::toggled, this,
                [this, field = line.field](bool isRight) { setRight(field, isRight); });
        remove->addAction(labelText(line.name), this, [this, field = line.field] { this->remove(field); });
    }
    axes->setEnabled(!axes->isEmpty());
    remove->setEnabled(!remove->isEmpty());
    menu->addSeparator();
    menu->addAction(tr("Add a pane"), this, &PlotBoard::addPane)->setEnabled(canAddPane());
    menu->addAction(panes_.size() == 1 ? tr("Remove all curves") : tr("Remove this pane"), this,
                    &PlotBoard::removePane);
    menu->popup(place);
}

bool PlotBoard::add(const FieldId &field) {
    if (has(field))
        return true;
    if (curves() >= maxCurves)
        return false;
    insert(panes_[chosen_], field, std::nullopt);
    showCurves();
    Q_EMIT changed();
    return true;
}

void PlotBoard::insert(Pane &pane, const FieldId &field, std::optional<bool> isRight) {
    pane.curves.push_back({field, curvePen(freePen()), std::nullopt, isRight});
    sampler_.add(field);
}

int PlotBoard::freePen() const {
    const auto isUsed = [this](const QPen &pen) {
        for (const Pane &pane : panes_)
            for (const Curve &curve : pane.curves)
                if (curve.pen == pen)
                    return true;
        return false;
    };
    int number = 0;
    while (number < curves() && isUsed(curvePen(number)))
        ++number;
    return number;
}

void PlotBoard::remove(const FieldId &field) {
    for (Pane &pane : panes_)
        pane.curves.erase(std::remove_if(pane.curves.begin(), pane.curves.end(),
                                         [&](const Curve &curve) { return curve.field == field; }),
                          pane.curves.end());
    sampler_.remove(field);
    showCurves();
    Q_EMIT changed();
}

void PlotBoard::addPane() {
    if (!canAddPane())
        return;
    newPane();
    chosen_ = panes_.size() - 1;
    showCurves();
    Q_EMIT changed();
}

void PlotBoard::removePane() {
    for (const Curve &curve : panes_[chosen_].curves)
        sampler_.remove(curve.field);
    panes_[chosen_].curves.clear();
    if (panes_.size() > 1) {
        auto *const widget = panes_[chosen_].widget;
        panes_.erase(panes_.begin() + std::ptrdiff_t(chosen_));
        chosen_ = std::min(chosen_, panes_.size() - 1);
        widget->scene().lines.clear();
        discard(widget); // its menu may be what asks; the focus goes to another pane, which is chosen then
    }
    showCurves();
    Q_EMIT changed();
}

void PlotBoard::choosePane(int pane) {
    chosen_ = std::min(std::size_t(pane), panes_.size() - 1);
    showCurves();
}

void PlotBoard::goLive() {
    for (const Pane &pane : panes_) {
        pane.widget->scene().left.automate();
        pane.widget->scene().right.automate();
    }
    time_.setHeld(false);
}

void PlotBoard::redraw() {
    if (!time_.isHeld() && curves() > 0)
        showCurves();
}

double PlotBoard::nowOf(const FieldId &field) {
    const QString clock = sampler_.clock(field);
    if (!time_.isHeld())
        return sampler_.now(clock);
    return heldNow_.emplace(clock, sampler_.now(clock)).first->second;
}

void PlotBoard::findUnit(Curve &curve) const {
    const DaemonLink *const daemon = curve.unit ? nullptr : fleet_.daemonAt(curve.field.address);
    if (daemon && daemon->hasTopic(curve.field.topic))
        curve.unit = unitAt(topicDescription(daemon->description(), curve.field.topic)["schema"].toObject(),
                            curve.field.path);
}

QString PlotBoard::ownerOf(const FieldId &field) const {
    const DaemonLink *const daemon = fleet_.daemonAt(field.address);
    return fleet_.robotOf(daemon) ? fleet_.titleOf(*daemon) : field.address;
}

// With the daemon where the same is plotted of two, and a word where recorded and live curves meet.
QString PlotBoard::nameOf(const FieldId &field) const {
    bool isTwice = false, isMixed = false;
    for (const auto &[other, samples] : sampler_.all()) {
        isTwice = isTwice || (other.topic == field.topic && other.path == field.path && !(other == field));
        isMixed = isMixed || (!samples.empty() && !sampler_.isRecorded(other));
    }
    QString name =
        shortLine(field.path.isEmpty() ? field.topic : field.topic + ' ' + field.path, longestName);
    if (isTwice)
        name += tr(" of %1").arg(ownerOf(field));
    return isMixed && sampler_.isRecorded(field) ? tr("recorded: %1").arg(name) : name;
}

void PlotBoard::showCurves() {
    if (time_.isHeld()) // all of them, also those whose curve begins while the picture stands
        for (const auto &[field, samples] : sampler_.all())
            nowOf(field);
    double legendWidth = 0;
    for (Pane &pane : panes_) {
        fillScene(pane);
        legendWidth = std::max(legendWidth, pane.widget->legendWidth());
    }
    const bool hasRight = std::any_of(panes_.begin(), panes_.end(), [](const Pane &pane) {
        const auto &lines = pane.widget->scene().lines;
        return std::any_of(lines.begin(), lines.end(), [](const PlotLine &line) { return line.isRight; });
    });
    for (const Pane &pane : panes_) { // so that one time is in one place
        pane.widget->scene().legendWidth = legendWidth;
        pane.widget->scene().hasRightAxis = hasRight;
        pane.widget->refresh();
    }
}

void PlotBoard::fillScene(Pane &pane) {
    PlotScene &scene = pane.widget->scene();
    scene.lines.clear();
    QString firstUnit;
    QStringList names;
    for (Curve &curve : pane.curves) {
        findUnit(curve);
        const QString unit = curve.unit.value_or(QString());
        if (names.isEmpty())
            firstUnit = unit;
        const Freshness &freshness = sampler_.freshness(curve.field);
        scene.lines.push_back({curve.field, nameOf(curve.field), unit, curve.pen,
                               curve.isRight.value_or(unit != firstUnit), nowOf(curve.field),
                               &sampler_.samples(curve.field), !freshness.isFresh(), freshness.text()});
        names.append(scene.lines.back().name);
    }
    scene.isChosen = panes_.size() > 1 && &pane == &panes_[chosen_];
    scene.hasTimeAxis = &pane == &panes_.back();
    scene.cursorTime = cursorTime();
    pane.widget->setAccessibleName(tr("Chart of %1").arg(names.join(", ")));
}

// "-3.20 s  14:03:12.45", with the date where it is not today.
QString PlotBoard::cursorTime() const {
    if (!time_.cursor_s())
        return {};
    const QString text = tr("%1 s").arg(*time_.cursor_s(), 0, 'f', 2);
    for (const Pane &pane : panes_)
        for (const PlotLine &line : pane.widget->scene().lines) {
            const auto time = line.samples->empty() ? std::nullopt : timeOf(line.now + *time_.cursor_s());
            if (!time)
                continue;
            const bool isToday = time->date() == QDate::currentDate();
            const QString wall = time->toString(isToday ? "HH:mm:ss.zzz" : "yyyy-MM-dd HH:mm:ss.zzz");
            return text + "  " + wall.chopped(1);
        }
    return text;
}

void PlotBoard::setRight(const FieldId &field, bool isRight) {
    for (Pane &pane : panes_)
        for (Curve &curve : pane.curves)
            if (curve.field == field)
                curve.isRight = isRight;
    showCurves();
}

void PlotBoard::render(QPainter &painter) const {
    for (const Pane &pane : panes_)
        pane.widget->painter(pane.widget->geometry()).paint(painter);
}

std::vector<KeptCurve> PlotBoard::kept() const {
    std::vector<KeptCurve> all;
    for (const auto &[field, samples] : sampler_.all())
        all.push_back({field, ownerOf(field), {}, samples});
    for (const Pane &pane : panes_)
        for (const Curve &curve : pane.curves)
            for (KeptCurve &one : all)
                if (one.field == curve.field)
                    one.unit = curve.unit.value_or(QString());
    return all;
}

} // namespace hermes::desktop
