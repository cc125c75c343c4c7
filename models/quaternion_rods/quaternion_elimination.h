#pragma once

#include "math/matrix3.h"

namespace tress::models {

/// Factors S of a clamped rod with a quaternion for every edge by elimination from the
/// tip to the root. Each edge has 7 unknowns: the change y = (e, q) of the vector along
/// it and of its quaternion. The change of the node before the edge is x, and that of the
/// quaternion before it is p. All that follows the edge is a matrix over its end and its
/// own quaternion:
///
///     (own + beyond) y + [beyond_x, joint_p] (x, p) = r.
///
/// Unknowns are changes of edges, not of nodes: masses would be lost next to the
/// stiffness of edges.
template <class T>
struct QuaternionElimination {
  static constexpr int size = 7;  // unknowns of an edge

  /// Derivatives of the forces of an edge over (e, q), inertia of the quaternion among
  /// them, and of the joint before it over (p, q).
  struct Own {
    T edge[size][size], joint[8][8];  // derivatives of the edge and of the joint
  };
  /// Factors of an edge.
  struct Factor {
    T matrix[size][size];     // factors, inverse pivots on the diagonal
    T by_before[size][size];  // change of the edge by the change before it
    T node[3][size];          // of the force on the node before, by (e, q)
    T joint[4][4];            // of that on the quaternion before, by q
    T solution[size];         // where the edge before does not move
  };
  /// Matrix over the end of an edge and its quaternion.
  struct Beyond {
    T matrix[size][size] = {};  // entries by rows

    /// Adds the block of the node at the end: inertia and loads.
    void add_block(const Matrix3<T>& m) {
      for (int k = 0; k < 3; ++k) {
        matrix[k][0] += m.row[k].x;
        matrix[k][1] += m.row[k].y;
        matrix[k][2] += m.row[k].z;
      }
    }
  };
  /// Right-hand side at the end of an edge and its quaternion.
  struct Right {
    T force[size] = {};  // entries
  };

  /// `first`: nothing before the edge moves.
  static void eliminate(const Own& own, bool first, Beyond& beyond, Factor& f) {
    auto& m = f.matrix;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) m[i][j] = own.edge[i][j] + beyond.matrix[i][j];
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) m[3 + i][3 + j] += own.joint[4 + i][4 + j];
    }
    factor(m);
    if (first) return;
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < 3; ++i) f.node[i][j] = beyond.matrix[i][j];
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) f.joint[i][j] = own.joint[i][4 + j];
    }
    for (int j = 0; j < size; ++j) {
      T column[size];
      for (int i = 0; i < size; ++i) {
        column[i] = j < 3 ? beyond.matrix[i][j] : i < 3 ? T(0) : own.joint[1 + i][j - 3];
      }
      solve(m, column);
      for (int i = 0; i < size; ++i) f.by_before[i][j] = column[i];
    }
    Beyond next;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) {
        T sum = i < 3 ? (j < 3 ? beyond.matrix[i][j] : T(0))
                      : (j < 3 ? T(0) : own.joint[i - 3][j - 3]);
        if (i < 3) {
          for (int k = 0; k < size; ++k) sum -= f.node[i][k] * f.by_before[k][j];
        } else {
          for (int k = 0; k < 4; ++k) sum -= f.joint[i - 3][k] * f.by_before[3 + k][j];
        }
        next.matrix[i][j] = sum;
      }
    }
    beyond = next;
  }

  /// `right`: of all beyond the edge, the node at its end among them; from then on with
  /// the edge, whose forces over (e, q) and (p, q) these are.
  static void reduce(const T (&edge)[size], const T (&joint)[8], bool first, Factor& f,
                     Right& right) {
    auto& y = f.solution;
    for (int i = 0; i < size; ++i) y[i] = edge[i] + right.force[i];
    for (int i = 0; i < 4; ++i) y[3 + i] += joint[4 + i];
    solve(f.matrix, y);
    if (first) return;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < size; ++k) right.force[i] -= f.node[i][k] * y[k];
    }
    for (int i = 0; i < 4; ++i) {
      T sum = joint[i];
      for (int k = 0; k < 4; ++k) sum -= f.joint[i][k] * y[3 + k];
      right.force[3 + i] = sum;
    }
  }

  /// y, with the changes (x, p) before it.
  static void change(const Factor& f, bool first, const T (&before)[size], T (&y)[size]) {
    for (int i = 0; i < size; ++i) {
      y[i] = f.solution[i];
      if (first) continue;
      for (int k = 0; k < size; ++k) y[i] -= f.by_before[i][k] * before[k];
    }
  }

 private:
  static void factor(T (&m)[size][size]) {
    for (int k = 0; k < size; ++k) {
      m[k][k] = T(1) / m[k][k];
      for (int i = k + 1; i < size; ++i) {
        m[i][k] = m[i][k] * m[k][k];
        for (int j = k + 1; j < size; ++j) m[i][j] -= m[i][k] * m[k][j];
      }
    }
  }
  static void solve(const T (&m)[size][size], T (&b)[size]) {
    for (int i = 1; i < size; ++i) {
      for (int k = 0; k < i; ++k) b[i] -= m[i][k] * b[k];
    }
    for (int i = size - 1; i >= 0; --i) {
      for (int k = i + 1; k < size; ++k) b[i] -= m[i][k] * b[k];
      b[i] = b[i] * m[i][i];
    }
  }
};

}  // namespace tress::models
