#include "study/write/clustering_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lobe::test {
namespace {

/// Four materials on a line, at 0, 1, 8 and 10, every distance within 1/2. All numbers below are exact or quotients of
/// exact ones.
class ClusteringText : public ::testing::Test {
 protected:
  ClusteringText() {
    for (const char* name : {"a", "b", "c, \"shiny\"", "d"}) materials_.push_back({name});
    metric_.distance.resize(4, 4);
    metric_.distance << 0, 1, 8, 10, 1, 0, 7, 9, 8, 7, 0, 2, 10, 9, 2, 0;
    metric_.distance_error.setConstant(4, 4, 0.5);
    metric_.distance_error.diagonal().setZero();
  }

  std::vector<MaterialLabel> materials_;
  Metric metric_;
};

TEST_F(ClusteringText, ListsMaterialsByMedoidAndDistance) {
  // Silhouette of a: 1 to b, 9 on the mean to c and d; (9 - 1) / 9 within (1 + 9) / 2 / 81.
  EXPECT_EQ(medoids_csv(materials_, metric_, cluster_materials(metric_, {.clusters = 2})),
            "medoid,material,distance,distance_error,silhouette,silhouette_error\n"
            "b,b,0,0,0.875,0.0703125\n"
            "b,a,1,0.5,0.8888888888888888,0.06172839506172839\n"
            "\"c, \"\"shiny\"\"\",\"c, \"\"shiny\"\"\",0,0,0.7333333333333333,0.08444444444444445\n"
            "\"c, \"\"shiny\"\"\",d,2,0.5,0.7894736842105263,0.06371191135734072\n");
}

TEST_F(ClusteringText, ListsNeighboursAndWhetherTheirRankIsSure) {
  EXPECT_EQ(neighbours_csv(materials_, cluster_materials(metric_, {.clusters = 2, .neighbours = 2})),
            "material,rank,neighbour,distance,distance_error,rank_uncertain\n"
            "a,1,b,1,0.5,no\n"
            "a,2,\"c, \"\"shiny\"\"\",8,0.5,no\n"
            "b,1,a,1,0.5,no\n"
            "b,2,\"c, \"\"shiny\"\"\",7,0.5,no\n"
            "\"c, \"\"shiny\"\"\",1,d,2,0.5,no\n"
            "\"c, \"\"shiny\"\"\",2,b,7,0.5,yes\n"
            "d,1,\"c, \"\"shiny\"\"\",2,0.5,no\n"
            "d,2,b,9,0.5,yes\n");
}

TEST_F(ClusteringText, PutsTheMedoidBeforeWhatCoincidesWithIt) {
  metric_.distance.setZero();
  const Clustering clustering = cluster_materials(metric_, {.clusters = 2});
  const std::string text = medoids_csv(materials_, metric_, clustering);
  const std::string first = materials_[clustering.medoids.medoid[0]].name;
  EXPECT_NE(text.find("\n" + first + "," + first + ","), std::string::npos) << text;
}

}  // namespace
}  // namespace lobe::test
