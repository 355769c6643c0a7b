//! Lists that are compiled here.
//!
//! Code that is generic over the number of dimensions is compiled by the crate that says which; whoever asks for a list would
//! compile all that stands in it. These are made here, one for each number of dimensions.

use core::any::Any;

/// Makes the lists `in_1`, `in_2` and `in_3` of the defaults of some types, as objects of a trait.
macro_rules! in_dimensions {
    ($door:ident: $($item:ty),*) => {
        in_dimensions!(@list in_1, 1, $door: $($item),*);
        in_dimensions!(@list in_2, 2, $door: $($item),*);
        in_dimensions!(@list in_3, 3, $door: $($item),*);
    };
    (@list $list:ident, $d:literal, $door:ident: $($item:ty),*) => {
        #[inline(never)]
        fn $list() -> Vec<Box<dyn $door<$d>>> {
            vec![$(Box::new(<$item>::default())),*]
        }
    };
}
pub(crate) use in_dimensions;

/// What that of three functions makes that makes what is asked for; `None` where none does.
pub(crate) fn of_dimension<One: Any, Two: Any, Three: Any, Wanted: Any>(
    one: fn() -> One,
    two: fn() -> Two,
    three: fn() -> Three,
) -> Option<Wanted> {
    made_by(one).or_else(|| made_by(two)).or_else(|| made_by(three))
}

fn made_by<Made: Any, Wanted: Any>(make: fn() -> Made) -> Option<Wanted> {
    let make: Box<dyn Any> = Box::new(make);
    make.downcast::<fn() -> Wanted>().ok().map(|make| make())
}
