#pragma once

// Everything that scan processing needs, in one include.
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/segmentation/EarSegmenter.h"
#include "vectorlib/tls/LineCovariance.h"
#include "vectorlib/tls/TlsFit.h"
#include "vectorlib/vectorization/AftlsVectorizer.h"
#include "vectorlib/vectorization/DouglasPeuckerVectorizer.h"
#include "vectorlib/vectorization/FtlsVectorizer.h"
#include "vectorlib/vectorization/IncVectorizer.h"
#include "vectorlib/vectorization/OptimalVectorizer.h"
#include "vectorlib/vectorization/ReumannWitkamVectorizer.h"
#include "vectorlib/vectorization/SplitAndMergeVectorizer.h"
#include "vectorlib/vectorization/TlsVectorizer.h"
