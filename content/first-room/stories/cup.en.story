<story>
<p><emotion name="joy" weight="0.35"/>Zuzana was the best <gesture name="explain"/>potter of this valley, <break time="200ms"/>and the most impatient.
One morning a rider came down from the castle and ordered a <gesture name="wonder" weight="0.7"/><emphasis>golden</emphasis> cup.
She had never worked in gold, so she wanted to throw it in clay first, <gesture name="present_right"/>as a pattern for the goldsmith.</p>

<p><gesture name="count_three"/>Three times she threw the cup in a hurry, <break time="250ms"/><emotion name="sadness" weight="0.4"/>and three times it cracked in the kiln.
On the third evening <gesture name="sigh"/>she swept up the shards and wanted to sell the wheel.</p>

<p><emotion name="surprise" weight="0.35"/>Then it was so <gesture name="listen"/>quiet in the room that she heard the clock.
<look at="clock"/><prosody rate="90%">It had ticked all the time, no faster and no slower than ever.</prosody><look at="visitor"/>
<emotion name="joy" weight="0.3"/>So she sat down again and let the wheel go round <gesture name="hands_folded"/>as calmly as the pendulum swings.</p>

<p><emotion name="joy" weight="0.7"/>The fourth cup came out of the fire <gesture name="emphasize"/><emphasis>whole</emphasis>, and as thin as a leaf.
The goldsmith took a mould of it, and <point at="cup"/>there it stands, in the glass case.
<look at="visitor"/>Her very first bowl is in the <look at="cupboard"/>cupboard, <break time="250ms"/>as crooked as a first bowl should be.<look at="visitor"/>
<emotion name="joy" weight="0.4"/>Whoever is in a hurry may <gesture name="invite"/>open the little door and look at it for a while.</p>
</story>
