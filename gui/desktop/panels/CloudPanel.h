#pragma once

#include "gui/desktop/view/CloudView.h"

namespace hermes::desktop {

class AgedLabel;
class PlainLabel;

/// The lidar's cloud in three dimensions, with what colours it and how many points it has. Costs nothing on
/// the link while it is not in sight.
class CloudPanel : public QWidget {
    Q_OBJECT
public:
    explicit CloudPanel(Fleet &fleet, QWidget *parent = nullptr);

    CloudView &view() { return *view_; }
    CloudModel &model() { return model_; }

protected:
    void showEvent(QShowEvent *event) override;
    void hideEvent(QHideEvent *event) override;

private:
    void onSight(bool isInSight);
    QLayout *makeTop();

    CloudModel model_;
    CloudView *view_;
    AgedLabel *summary_;
    PlainLabel *way_; ///< in which it is drawn
};

} // namespace hermes::desktop
