"""What a scene will run."""

import click

from verify.commands.shared import (
    GATE_FAILED,
    json_alone,
    load,
    overridden,
    print_json,
    scene_name,
)


@click.command()
@scene_name
@overridden
@json_alone
def plan(scene: str, overrides: tuple[str, ...], as_json: bool) -> None:
    """Print what SCENE will run, what is skipped, and why; exit 1 where something cannot run.

    It solves nothing but two or three exact fields under a slider, by which it says how the slider is coupled.

    Example: `verify plan paper`
    """
    from verify.run.applies import that_change
    from verify.run.plan import plan_scene

    asked = load(scene, overrides)
    planned = plan_scene(asked, that_change(scene, overrides))
    if as_json:
        import msgspec

        print_json(msgspec.to_builtins(planned))
    else:
        from verify.report.terminal import Terminal, print_plan, print_remarks
        from verify.run.remarks import remarks_on

        print_remarks(remarks_on(asked), Terminal())
        print_plan(planned)
    if planned.problems:
        raise SystemExit(GATE_FAILED)
