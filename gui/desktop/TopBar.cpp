#include "gui/desktop/TopBar.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>

namespace hermes {

TopBar::TopBar(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , robots_(new QComboBox)
    , link_(new QLabel) {
    robots_->setObjectName("robots");
    robots_->setToolTip(tr("The robot that the panels show and drive"));
    robots_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
    link_->setObjectName("link");
    link_->setToolTip(tr("The longest time that a daemon of this robot takes to answer"));

    auto *const layout = new QHBoxLayout(this);
    auto *const label = new QLabel(tr("&Robot"));
    label->setBuddy(robots_);
    layout->addWidget(label);
    layout->addWidget(robots_);
    layout->addWidget(link_);
    layout->addStretch();

    connect(robots_, QOverload<int>::of(&QComboBox::activated), this,
            [this](int index) { fleet_.choose(fleet_.robots().at(size_t(index)).get()); });
    connect(&fleet, &Fleet::changed, this, &TopBar::updateRobots);
    connect(&fleet, &Fleet::changed, this, &TopBar::updateLink);
    connect(&fleet, &Fleet::robotChosen, this, &TopBar::updateRobots);
    connect(&fleet, &Fleet::robotChosen, this, &TopBar::updateLink);
    updateRobots();
    updateLink();
}

void TopBar::updateRobots() {
    QStringList names;
    for (const auto &robot : fleet_.robots())
        names.append(robot->name());
    QStringList shown;
    for (int i = 0; i < robots_->count(); ++i)
        shown.append(robots_->itemText(i));
    if (names != shown) {
        robots_->clear();
        robots_->addItems(names);
    }
    for (size_t i = 0; i < fleet_.robots().size(); ++i)
        if (fleet_.robots()[i].get() == fleet_.robot())
            robots_->setCurrentIndex(int(i));
}

void TopBar::updateLink() {
    double worst = -1;
    if (const Robot *const robot = fleet_.robot())
        for (const DaemonLink *daemon : robot->daemons())
            worst = std::max(worst, daemon->latency_ms());
    link_->setText(worst < 0    ? tr("no link")
                   : worst < 10 ? tr("link %1 ms").arg(worst, 0, 'f', 1)
                                : tr("link %1 ms").arg(worst, 0, 'f', 0));
}

} // namespace hermes
