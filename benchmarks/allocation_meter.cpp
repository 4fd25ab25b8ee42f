// Replaces the global operator new and delete of a program. The size of each block stands just before it.

#include "benchmarks/allocation_meter.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::atomic<std::int64_t> count{0};
std::atomic<std::int64_t> live{0};

// Room before a block, which keeps its alignment.
std::size_t room(std::size_t alignment) { return std::max(alignment, alignof(std::max_align_t)); }

void* take(std::size_t size, std::size_t alignment) {
  const std::size_t before = room(alignment);
  const std::size_t whole = (before + size + before - 1) / before * before;
  void* const memory = std::aligned_alloc(before, whole);
  if (memory == nullptr) throw std::bad_alloc();
  std::byte* const block = static_cast<std::byte*>(memory) + before;
  std::memcpy(block - sizeof(size), &size, sizeof(size));
  count.fetch_add(1, std::memory_order_relaxed);
  live.fetch_add(static_cast<std::int64_t>(size), std::memory_order_relaxed);
  return block;
}

void give_back(void* memory, std::size_t alignment) noexcept {
  if (memory == nullptr) return;
  std::byte* const block = static_cast<std::byte*>(memory);
  std::size_t size = 0;
  std::memcpy(&size, block - sizeof(size), sizeof(size));
  live.fetch_sub(static_cast<std::int64_t>(size), std::memory_order_relaxed);
  std::free(block - room(alignment));
}

constexpr std::size_t plain = alignof(std::max_align_t);
constexpr std::size_t number(std::align_val_t alignment) { return static_cast<std::size_t>(alignment); }

}  // namespace

std::int64_t benchmarks::allocations() { return count.load(std::memory_order_relaxed); }
std::int64_t benchmarks::live_bytes() { return live.load(std::memory_order_relaxed); }

// The forms that throw nothing call these by default.
void* operator new(std::size_t size) { return take(size, plain); }
void* operator new[](std::size_t size) { return take(size, plain); }
void* operator new(std::size_t size, std::align_val_t alignment) { return take(size, number(alignment)); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return take(size, number(alignment)); }
void operator delete(void* memory) noexcept { give_back(memory, plain); }
void operator delete[](void* memory) noexcept { give_back(memory, plain); }
void operator delete(void* memory, std::size_t) noexcept { give_back(memory, plain); }
void operator delete[](void* memory, std::size_t) noexcept { give_back(memory, plain); }
void operator delete(void* memory, std::align_val_t alignment) noexcept {
  give_back(memory, number(alignment));
}
void operator delete[](void* memory, std::align_val_t alignment) noexcept {
  give_back(memory, number(alignment));
}
void operator delete(void* memory, std::size_t, std::align_val_t alignment) noexcept {
  give_back(memory, number(alignment));
}
void operator delete[](void* memory, std::size_t, std::align_val_t alignment) noexcept {
  give_back(memory, number(alignment));
}
