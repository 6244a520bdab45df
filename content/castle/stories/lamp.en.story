<story>
<p><emotion name="joy" weight="0.4"/><look at="visitor"/>Do you <gesture name="think" weight="0.7"/>trust your eyes?
<point at="alexandrite"/>Over there lies a stone, and by day it is as green as moss.</p>

<p><look at="visitor"/>A pedlar <gesture name="explain" weight="0.7"/>brought it to this hall, and swore that it was an emerald.
<emotion name="surprise" weight="0.3"/>The lord of the castle held it to the window all morning, and then he paid for it with <gesture name="count_three"/>three good fields.
<emotion name="neutral"/>In the evening he gave it to his wife at table.
<prosody rate="90%"><hold name="torch"/>The candles were lit, she opened her hand,</prosody> <break time="400ms"/><emotion name="surprise" weight="0.7"/>and the stone was <emphasis>red</emphasis>.</p>

<p><emotion name="fear" weight="0.5"/>He shouted for the guard, and he shouted for the priest.
<prosody volume="soft" rate="90%">All night long they sat around it, <gesture name="hush" weight="0.6"/>and all night long it stayed as red as wine.</prosody>
<hold name="nothing"/><break time="300ms"/><emotion name="joy" weight="0.6"/>Then the <gesture name="wonder"/>sun came in at these windows, <break time="150ms"/>and there it lay, green.</p>

<p><look at="alexandrite"/><emotion name="neutral"/>Nobody had cheated him.
<look at="visitor"/>The stone keeps yellow and violet for itself, <gesture name="explain"/>and gives back all the rest.
Of daylight that leaves green, <break time="200ms"/>and of a candle, which has hardly any blue, <gesture name="point_up" weight="0.8"/>it leaves red.</p>

<p><emotion name="joy" weight="0.35"/><point at="second-falcon"/>And the painting by the gate keeps a secret of the same kind.
<look at="visitor"/>Once there were <gesture name="count_two"/>two falcons in its sky, and somebody painted one of them over.
<prosody volume="soft" rate="92%">By day nobody will ever find it.</prosody>
<show piece="second-falcon" layer="candle"/><gesture name="beckon" weight="0.7"/>Look at it by another lamp.</p>

<p><emotion name="joy" weight="0.5"/>“But what colour is it <emphasis>really</emphasis>?” ask all the children.
<look at="alexandrite"/>The lady of the castle knew the answer, and she wore that stone all her life.
<look at="visitor"/><prosody pitch="+6%" rate="88%">“First <gesture name="heart"/>tell me,” she said, “by whose light.”</prosody></p>
</story>
