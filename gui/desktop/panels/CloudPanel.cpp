#include "gui/desktop/panels/CloudPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/AgedLabel.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/Seen.h"

#include <QComboBox>
#include <QPushButton>

namespace hermes::desktop {

CloudPanel::CloudPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , model_(fleet)
    , view_(named(new CloudView(model_), "cloudView",
                  tr("Left button: turn. Right or middle button: move. Wheel: zoom.\n"
                     "Home, End, Page up, Page down: turn. +, -: zoom. 0: all of it.")))
    , summary_(
          named(new AgedLabel, "cloudSummary",
                tr("Of the last turn of the lidar. The setting cloud.max_points of its logger thins it.")))
    , way_(named(new PlainLabel, "cloudWay",
                 tr("No graphics card can be used here: the processor draws the points, with fewer pictures "
                    "a second"))) {
    view_->setAccessibleName(tr("Cloud of the lidar"));
    filled(this, inColumn({makeTop(), {view_, 1}}), 2);
    setFocusProxy(view_);
    const auto tell = [this] { summary_->tell(model_.summary(), model_.age()); };
    connect(&model_, &CloudModel::changed, this, tell);
    connect(view_, &CloudView::rendererChanged, this, [this] {
        way_->setText(view_->renderer()->isByOpenGl() ? QString() : tr("without graphics card"));
    });
    tell();
}

QLayout *CloudPanel::makeTop() {
    auto *const colour =
        named(new QComboBox, "cloudColour",
              tr("Height above the lidar in metres, or how much of the light came back (0 to 255)"));
    colour->addItems({tr("height"), tr("intensity")});
    auto *const label = new PlainLabel(tr("Colour"));
    label->setBuddy(colour);
    colour->setAccessibleName(tr("Colour of the points"));
    auto *const reset = named(new QPushButton(theme::icon("fit"), tr("Reset view")), "resetCloud",
                              tr("All of the cloud, from behind the robot (0)"));
    connect(reset, &QPushButton::clicked, view_, &CloudView::resetView);
    connect(colour, QOverload<int>::of(&QComboBox::currentIndexChanged), view_,
            [this](int index) { view_->colourBy(CloudScene::Colouring(index)); });
    QLayout *const top = inRow({label, colour, reset, {summary_, 1}, way_});
    top->setContentsMargins(6, 2, 6, 0);
    top->setSpacing(10);
    return top;
}

void CloudPanel::onSight(bool isInSight) {
    // One that is taken out of its tabs says that it is not in sight.
    const auto *const dock = qobject_cast<const QDockWidget *>(sender());
    model_.setEnabled(isInSight || (dock && dock->isFloating() && isVisible()));
}

// A tab over the panel does not hide it.
void CloudPanel::showEvent(QShowEvent *event) {
    const QDockWidget *const dock = dockOf(*this);
    if (dock)
        connect(dock, &QDockWidget::visibilityChanged, this, &CloudPanel::onSight, Qt::UniqueConnection);
    if (!dock || dock->isFloating())
        onSight(true);
    QWidget::showEvent(event);
}

void CloudPanel::hideEvent(QHideEvent *event) {
    onSight(false);
    QWidget::hideEvent(event);
}

} // namespace hermes::desktop
