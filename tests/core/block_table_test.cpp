#include <carom/core/block_table.h>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace {

using namespace carom;

/// Particles of the plane, one component.
struct Chain {
  explicit Chain(Index bodies) {
    std::vector<BodySlot> list;
    for (Index i = 0; i < bodies; ++i) list.push_back({i, 2 * i, 2 * i, 2, 2, none, 0, i});
    slots = BodySlots(list, 2);
    components = {{{0, bodies}, {0, 2 * bodies}, {0, 2 * bodies}, {}, {}, {}}};
    table = BlockTable(components, slots, 1);
  }
  Index part(Index a, Index b) { return table.part_of(components[0], std::array{a, b}); }

  BodySlots slots;
  std::vector<Component> components;
  BlockTable table;
};

TEST(BlockTable, SmallComponentsAreOneBlock) {
  Chain chain(2 * BlockTable::block_size - 1);
  ASSERT_EQ(chain.table.size(), 1U);
  EXPECT_EQ(chain.table[0].bodies.end, 2 * BlockTable::block_size - 1);
  EXPECT_EQ(chain.table.runs().size(), 1U);
  EXPECT_EQ(chain.part(0, 900), 0U);
}

TEST(BlockTable, BlocksAndRunsCoverTheComponent) {
  const Index blocks = 100;
  const Chain chain(blocks * BlockTable::block_size);
  ASSERT_EQ(chain.table.size(), blocks);
  EXPECT_EQ(chain.table.runs().size(), BlockTable::most_runs);
  Index body = 0, v = 0;
  for (const Block& block : chain.table) {
    EXPECT_EQ(block.bodies.begin, body);
    EXPECT_EQ(block.v.begin, v);
    body = block.bodies.end;
    v = block.v.end;
  }
  EXPECT_EQ(body, chain.components[0].bodies.end);
  EXPECT_EQ(v, chain.components[0].v.end);
}

TEST(BlockTable, AnElementIsInTheLastBlockItActsOn) {
  Chain chain(4 * BlockTable::block_size);  // two runs of two blocks
  const Index size = BlockTable::block_size;
  ASSERT_EQ(chain.table.runs().size(), 2U);
  EXPECT_EQ(chain.part(0, 1), 0U);
  EXPECT_EQ(chain.part(size, 0), 1U);
  EXPECT_EQ(chain.part(2 * size - 1, 2 * size), 4U) << "a bridge";
  chain.table.place_element(chain.components, 0, 0, 0, 0);
  chain.table.place_element(chain.components, 0, 0, 1, 1);
  chain.table.place_element(chain.components, 0, 0, 4, 2);
  chain.table.close();
  EXPECT_EQ(chain.table.elements_up_to(0, 0).size(), 1U);
  EXPECT_EQ(chain.table.elements_up_to(1, 0).begin, 1U);
  EXPECT_EQ(chain.table.bridges(0, 0).begin, 2U);
  EXPECT_EQ(chain.table[0].last_loading_block, 1U);
  EXPECT_FALSE(chain.table[0].loaded_across_runs);
  EXPECT_TRUE(chain.table[1].loaded_across_runs);

  Surroundings around;
  around.inner = {0};
  ASSERT_TRUE(chain.table.surround(around));
  EXPECT_EQ(around.loading, (std::vector<Index>{0, 1}));
  EXPECT_EQ(around.touched, (std::vector<Index>{0, 1}));
  around.inner = {1};
  EXPECT_FALSE(chain.table.surround(around));
}

}  // namespace
