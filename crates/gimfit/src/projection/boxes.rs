//! A tree of boxes, to find what is near without looking at everything.

/// Boxes of pieces, and boxes of those boxes.
#[derive(Debug, Clone)]
pub(super) struct BoxTree {
    dimension: usize,
    /// Lower, then upper corner of each node.
    corners: Vec<f64>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    Leaf(u32),
    /// The first child follows its parent; this is the second.
    Pair(u32),
}

/// Share by which a square of a distance must undercut another one to count.
pub(super) const SLACK: f64 = 1e-12;

impl BoxTree {
    /// Over pieces, given each as the points that it lies between, `points` to a piece.
    pub(super) fn new(coordinates: &[f64], points: usize, dimension: usize) -> Self {
        let pieces = coordinates.chunks_exact(points * dimension);
        let boxes: Vec<f64> = pieces.flat_map(|piece| corners_of(piece, dimension)).collect();
        let count = boxes.len() / (2 * dimension);
        let mut order: Vec<u32> = (0..count as u32).collect();
        let mut tree = Self {
            dimension,
            corners: Vec::with_capacity(4 * dimension * count),
            nodes: Vec::with_capacity(2 * count),
        };
        tree.grow(&boxes, &mut order);
        tree
    }

    /// Adds a node over some pieces, and all below it. The halves are even, so it ends 32 levels
    /// down at the latest.
    fn grow(&mut self, boxes: &[f64], order: &mut [u32]) {
        let size = 2 * self.dimension;
        let start = self.corners.len();
        let of = |piece: u32| &boxes[piece as usize * size..][..size];
        self.corners.extend_from_slice(of(order[0]));
        let hull = &mut self.corners[start..];
        for &piece in &order[1..] {
            for (k, (x, y)) in hull.iter_mut().zip(of(piece)).enumerate() {
                *x = if k < self.dimension { x.min(*y) } else { x.max(*y) };
            }
        }
        if let [piece] = order {
            self.nodes.push(Node::Leaf(*piece));
            return;
        }
        let extent = |k: usize| hull[self.dimension + k] - hull[k];
        let widest = (1..self.dimension).fold(0, |w, k| if extent(k) > extent(w) { k } else { w });
        let middle = |piece: &u32| {
            let corners = of(*piece);
            corners[widest] * 0.5 + corners[self.dimension + widest] * 0.5
        };
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| {
            middle(a).total_cmp(&middle(b)).then_with(|| a.cmp(b))
        });
        let node = self.nodes.len();
        self.nodes.push(Node::Pair(0));
        let (first, second) = order.split_at_mut(half);
        self.grow(boxes, first);
        self.nodes[node] = Node::Pair(self.nodes.len() as u32);
        self.grow(boxes, second);
    }

    /// Square of the distance of a point from the box of a node.
    fn distance(&self, node: usize, point: &[f64]) -> f64 {
        let corners = &self.corners[node * 2 * self.dimension..][..2 * self.dimension];
        // The usual dimensions as numbers that the compiler knows.
        match self.dimension {
            2 => box_distance::<2>(corners, point),
            3 => box_distance::<3>(corners, point),
            _ => box_distance::<0>(corners, point),
        }
    }

    /// Calls `visit` with pieces, near ones first, that may come nearer than the square it gave
    /// back last; `stack` is scratch.
    pub(super) fn search(
        &self,
        point: &[f64],
        stack: &mut Vec<(u32, f64)>,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let mut best = f64::INFINITY;
        stack.clear();
        stack.push((0, self.distance(0, point)));
        while let Some((node, bound)) = stack.pop() {
            if bound > best * (1.0 - SLACK) {
                continue;
            }
            match self.nodes[node as usize] {
                Node::Leaf(piece) => best = visit(piece as usize),
                Node::Pair(second) => {
                    let first = node + 1;
                    let bounds = [first, second].map(|child| self.distance(child as usize, point));
                    let pairs = [(first, bounds[0]), (second, bounds[1])];
                    // The nearer one is taken up first.
                    let order = if bounds[0] <= bounds[1] { [1, 0] } else { [0, 1] };
                    stack.extend(
                        order
                            .map(|k| pairs[k])
                            .iter()
                            .filter(|pair| pair.1 <= best * (1.0 - SLACK)),
                    );
                }
            }
        }
    }
}

/// `D` is the dimension known at compile time, or 0 for one known only now.
#[inline(always)]
fn box_distance<const D: usize>(corners: &[f64], point: &[f64]) -> f64 {
    let dimension = if D == 0 { point.len() } else { D };
    let (lower, upper) = corners.split_at(dimension);
    let (point, upper) = (&point[..dimension], &upper[..dimension]);
    let mut sum = 0.0;
    for k in 0..dimension {
        let gap = (lower[k] - point[k]).max(point[k] - upper[k]).max(0.0);
        sum += gap * gap;
    }
    sum
}

fn corners_of(points: &[f64], dimension: usize) -> Vec<f64> {
    let mut corners = [&points[..dimension], &points[..dimension]].concat();
    for point in points.chunks_exact(dimension) {
        for (k, x) in point.iter().enumerate() {
            corners[k] = corners[k].min(*x);
            corners[dimension + k] = corners[dimension + k].max(*x);
        }
    }
    corners
}
